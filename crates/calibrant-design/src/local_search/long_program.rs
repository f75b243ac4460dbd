//! The convex program of one iteration for long motions, with a smooth criterion.
//!
//! The information is matrix convex in the motion, so its linearisation is a lower bound that touches it.
//! A criterion of the linearised information is then a convex upper bound of the criterion. The program
//! minimises a model of that bound over the admissible motions. The model is of first order in the motion's
//! curvature and of second order in the criterion's ([`crate::criterion::criterion_model`]). It is linear but for a few
//! squares, so the program is one of chains ([`crate::convex::chain_program`]), and its time is proportional to the length
//! of the motion.
//!
//! # References
//! `boyd2004`, `pukelsheim2006`

use super::{ModelBend, Nodes, Part, Peaks, Rounds};
use crate::convex::{ChainProgram, Form, Stage, StageRow, Stages};
use crate::criterion::{Curvature, pieces};
use calibrant_core::information::InformationDerivative;
use nalgebra::{DMatrix, SMatrix, SVector};

/// Relative size of an eigenvalue that adds nothing to the rank.
const RANK: f64 = 1e-12;
/// Margin of the size of an increment at the start.
const MARGIN: f64 = 0.1;

/// What one iteration leaves for the next.
pub(crate) struct LongProgram<const D: usize> {
    rounds: Rounds<D>,
    pub(crate) bend: ModelBend,
}

/// A convex model of the criterion around a motion.
struct Model<const D: usize> {
    slope: Nodes<D>,
    /// Half the sum of the squares of these forms is the bend; by form and unknown `i D + k`.
    bends: DMatrix<f64>,
    /// Loss of the criterion per variance of each increment; empty unless this is modelled apart.
    noise: Vec<SVector<f64, D>>,
    /// Factor on the bend of these variances. Their kinks at increments of zero have no factor.
    noise_bend: f64,
}

impl<const D: usize> LongProgram<D> {
    pub(crate) fn new() -> Self {
        Self { rounds: Rounds::new(), bend: ModelBend::full() }
    }

    /// The admissible motion that minimises the model around a motion, and what it promises: the decrease of the model from
    /// `a`, relative to the most that the gradient could promise. The motion of the model need not be admissible.
    pub(crate) fn step<const P: usize>(
        &mut self,
        part: &Part<D, P>,
        around: &[SVector<f64, D>],
        a: &[SVector<f64, D>],
    ) -> Option<(Nodes<D>, f64)> {
        let model = part.model(around, self.bend.factor())?;
        let complete = |stages: &mut Stages| {
            if !model.noise.is_empty() {
                stages.iter_mut().flatten().for_each(|z| z[4] = z[3].abs() + MARGIN);
            }
        };
        self.rounds.solve(part, a, |peaks| part.chain_program(around, a, &model, peaks), complete)
    }
}

impl<const D: usize, const P: usize> Part<D, P> {
    /// The model at a motion. `None` where the motion does not determine the parameters.
    fn model(&self, a: &[SVector<f64, D>], bend: f64) -> Option<Model<D>> {
        let at = self.information.linearise(a)?;
        let c = self.covariance(&at)?;
        let (_, Curvature { first, forms }) = pieces(&self.criterion, &c, self.floor_of_d()).pop()?;
        let on_information =
            |form: &DMatrix<f64>| self.on_information(&SMatrix::<f64, P, P>::from_fn(|i, j| form[(i, j)]));
        let omega = on_information(&first);
        let forms: Vec<_> = forms.iter().map(on_information).collect();
        let derivative = self.information.derivative(&at, &omega);
        let mut total = self.information.total(a, &derivative);
        let InformationDerivative { nodes, variances } = derivative;
        let kinked = self.information.input_noise().filter(|(_, ratio)| *ratio > 0.0);
        let (slope, noise) = if let Some((floor, ratio)) = kinked {
            // the kinks stand in the program as they are
            for (i, variance) in variances.iter().enumerate() {
                let factor = 2.0 * floor * ratio * self.information.interval_s(i);
                let kink = variance.component_mul(&(a[i + 1] - a[i]).map(f64::signum)) * factor;
                total[i] += kink;
                total[i + 1] -= kink;
            }
            let slope = nodes.iter().zip(&total).map(|(held, all)| -(held * bend + all * (1.0 - bend)));
            (slope.collect(), variances.iter().map(|v| -v).collect())
        } else {
            (total.iter().map(|total| -total).collect(), Vec::new())
        };
        let signs: Vec<_> = a.windows(2).map(|pair| (pair[1] - pair[0]).map(f64::signum)).collect();
        let changes = self.information.first_derivatives(a, &at, &signs);
        Some(Model { slope, bends: independent(&forms, &changes) * bend.sqrt(), noise, noise_bend: bend })
    }

    /// The program of the model, in units of the most that the gradient could promise.
    fn chain_program(
        &self,
        around: &[SVector<f64, D>],
        a: &[SVector<f64, D>],
        model: &Model<D>,
        peaks: &[Peaks; D],
    ) -> ChainProgram {
        let size = |k: usize| self.regions[k].size;
        let reach =
            model.slope.iter().map(|s| (0..D).map(|k| s[k].abs() * size(k)).sum::<f64>()).sum::<f64>();
        let scale = if reach > 0.0 { 1.0 / reach } else { 1.0 };
        let mut chains: Vec<_> =
            self.regions.iter().zip(peaks).map(|(region, peaks)| region.chain(peaks)).collect();
        for (k, chain) in chains.iter_mut().enumerate() {
            chain.slope.iter_mut().zip(&model.slope).for_each(|(z, slope)| z[0] = slope[k] * size(k) * scale);
        }
        if let (false, Some((floor, ratio))) = (model.noise.is_empty(), self.information.input_noise()) {
            // s ≥ |u|: a larger increment brings the noise (floor Δτ + ratio s)²
            for (i, noise) in model.noise.iter().enumerate() {
                for (k, chain) in chains.iter_mut().enumerate() {
                    let weight = noise[k] * scale * size(k) * ratio;
                    chain.slope[i][4] = 2.0 * weight * floor * self.information.interval_s(i);
                    chain.square[i] = (2.0 * weight * size(k) * ratio * model.noise_bend).max(1e-12);
                    for sign in [1.0, -1.0] {
                        let c = Stage::new(0.0, 0.0, 0.0, sign, -1.0);
                        chain.rows.push(StageRow { stage: i, c, bound: 0.0 });
                    }
                }
            }
        }
        let stages = |a: &[SVector<f64, D>]| {
            let mut stages: Vec<Vec<Stage>> = Vec::new();
            for (k, region) in self.regions.iter().enumerate() {
                stages.push(region.stages(&a.iter().map(|node| node[k]).collect::<Vec<f64>>()));
            }
            if !model.noise.is_empty() {
                stages.iter_mut().flatten().for_each(|z| z[4] = z[3].abs());
            }
            stages
        };
        let here = stages(around);
        let forms = model.bends.row_iter().map(|row| {
            let of = |k: usize| (0..a.len()).map(|i| row[i * D + k] * size(k) * scale.sqrt()).collect();
            let mut form = Form { b: (0..D).map(of).collect(), offset: 0.0 };
            form.offset = form.at(&here);
            form
        });
        let mut program = ChainProgram { forms: forms.collect(), chains, matrix: None, reached: 0.0 };
        let own = stages(a);
        program.reached = program.objective(&own, &program.forms_at(&own));
        program
    }
}

/// The forms `⟨Ω_m, dF⟩` of the change of the motion, combined so that the sum of their squares is the same and none is
/// superfluous.
fn independent<const P: usize>(forms: &[SMatrix<f64, P, P>], changes: &[SMatrix<f64, P, P>]) -> DMatrix<f64> {
    if forms.is_empty() {
        // the criterion has no curvature here
        return DMatrix::zeros(0, changes.len());
    }
    // symmetric matrices by their upper triangles
    let places: Vec<(usize, usize)> = (0..P).flat_map(|j| (0..=j).map(move |i| (i, j))).collect();
    let forms = DMatrix::from_fn(forms.len(), places.len(), |m, at| {
        let (i, j) = places[at];
        forms[m][(i, j)] + if i == j { 0.0 } else { forms[m][(j, i)] }
    });
    let changes = DMatrix::from_fn(places.len(), changes.len(), |at, unknown| changes[unknown][places[at]]);
    let gram = &forms * (&changes * changes.transpose()) * forms.transpose();
    let eigen = ((&gram + gram.transpose()) * 0.5).symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let kept: Vec<usize> =
        (0..eigen.eigenvalues.len()).filter(|&k| eigen.eigenvalues[k] > RANK * largest).collect();
    eigen.eigenvectors.select_columns(&kept).tr_mul(&forms) * changes
}
