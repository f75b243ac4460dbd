//! The convex program of one iteration for criterion M, which is not smooth.
//!
//! Every criterion of the linearised information is a convex upper bound of the criterion ([`crate::local_search::long_program`]).
//! M is the largest of several smooth pieces, and so is the program's objective: a variable above all of them.
//!
//! # References
//! `boyd2004`, `pukelsheim2006`

use super::{ModelBend, Nodes, Part};
use crate::convex::{ConicProgram, Row};
use crate::criterion::Curvature;
use crate::limits::WatchedIntervals;
use nalgebra::{DMatrix, SMatrix, SVector};

/// Relative size of an eigenvalue that adds nothing to the rank.
const RANK: f64 = 1e-12;

/// What one iteration leaves for the next.
pub(crate) struct EpigraphProgram<const D: usize> {
    watch: [WatchedIntervals; D],
    /// Multipliers of the pieces of M.
    weights: Vec<f64>,
    pub(crate) bend: ModelBend,
}

impl<const D: usize> EpigraphProgram<D> {
    pub(crate) fn new(parameters: usize) -> Self {
        Self {
            watch: std::array::from_fn(|_| WatchedIntervals::default()),
            weights: vec![1.0; parameters],
            bend: ModelBend::full(),
        }
    }

    /// The admissible motion that minimises the model, and what it promises.
    pub(crate) fn step<const P: usize>(
        &mut self,
        part: &Part<D, P>,
        a: &[SVector<f64, D>],
    ) -> Option<(Nodes<D>, f64)> {
        let model = part.pieces(a, &self.weights, self.bend.factor())?;
        part.epigraph_step(a, &model, &mut self.watch, &mut self.weights)
    }
}

impl<const D: usize, const P: usize> Part<D, P> {
    /// Linear forms of the step in place of those of the information.
    fn pieces(&self, a: &[SVector<f64, D>], weights: &[f64], bend: f64) -> Option<Model<D>> {
        let at = self.information.linearise(a)?;
        let c = self.covariance(&at)?;
        let fixed =
            |omega: &DMatrix<f64>| self.on_information(&SMatrix::<f64, P, P>::from_fn(|i, j| omega[(i, j)]));
        let along = |omega: &DMatrix<f64>| {
            self.information.total(a, &self.information.derivative(&at, &fixed(omega)))
        };
        let pieces = crate::criterion::pieces(&self.criterion, &c, self.floor_of_d());
        let mut model = Model { pieces: Vec::new(), bends: Vec::new() };
        let total: f64 = weights.iter().take(pieces.len()).sum();
        for ((value, Curvature { first, forms }), weight) in pieces.into_iter().zip(weights) {
            let derivative = self.information.derivative(&at, &fixed(&first));
            let slope = self.information.total(a, &derivative);
            model.pieces.push((value, slope.iter().map(|slope| -slope).collect()));
            let share = (bend * weight / total).sqrt();
            if share > 1e-4 * bend.sqrt() {
                model.bends.extend(
                    forms
                        .iter()
                        .map(|form| along(form).into_iter().map(|row| row * share).collect::<Nodes<D>>()),
                );
            }
        }
        reduce(&mut model.bends);
        Some(model)
    }

    /// The admissible motion that minimises the model. Also its predicted decrease, relative to the most that
    /// the gradient could promise.
    fn epigraph_step(
        &self,
        a: &[SVector<f64, D>],
        model: &Model<D>,
        watch: &mut [WatchedIntervals; D],
        weights: &mut [f64],
    ) -> Option<(Nodes<D>, f64)> {
        // watched intervals are few and are found soon
        for _ in 0..8 {
            let (program, first_piece) = self.program(a, model, watch);
            let solution = program.solve()?;
            let next: Nodes<D> = (0..a.len())
                .map(|i| SVector::from_fn(|k, _| self.regions[k].size * solution.x[i * D + k]))
                .collect();
            let mut news = false;
            for k in 0..D {
                let nodes: Vec<f64> = next.iter().map(|node| node[k]).collect();
                news |= self.regions[k].update_watch(&nodes, &mut watch[k]);
            }
            if news {
                continue;
            }
            if let Some(first) = first_piece {
                for (k, weight) in weights.iter_mut().take(model.pieces.len()).enumerate() {
                    *weight = solution.multipliers[first + k].max(1e-12);
                }
            }
            let promise = self.promise(a, model, &next);
            return Some((next, promise));
        }
        None
    }

    /// The convex program of one iteration, and the number of its first row for the pieces of M.
    fn program(
        &self,
        a: &[SVector<f64, D>],
        model: &Model<D>,
        watch: &[WatchedIntervals; D],
    ) -> (ConicProgram, Option<usize>) {
        let mut program = ConicProgram::default();
        program.add_variables(a.len() * D);
        for (k, region) in self.regions.iter().enumerate() {
            region.add_to(&mut program, |i| i * D + k, &watch[k]);
        }
        // form · (x − a), in the program's variables
        let along = |form: &[SVector<f64, D>], scale: f64| {
            let mut row = Row::default();
            for (i, node) in form.iter().enumerate() {
                for k in 0..D {
                    row.terms.push((i * D + k, node[k] * self.regions[k].size * scale));
                    row.constant -= node[k] * a[i][k] * scale;
                }
            }
            row
        };
        let scale = 1.0 / self.reach(model);
        let z = program.add_variables(model.bends.len());
        for (k, bend) in model.bends.iter().enumerate() {
            program.add_square(z + k, 1.0);
            program.zero(along(bend, scale.sqrt()).plus(&Row::new(0.0, [(z + k, -1.0)])));
        }
        let t = program.add_variables(1);
        program.add_linear(t, 1.0);
        let best = model.pieces.iter().map(|(value, _)| *value).fold(f64::NEG_INFINITY, f64::max);
        let mut first = None;
        for (value, slope) in &model.pieces {
            let row = along(slope, -scale).plus(&Row::new((best - value) * scale, [(t, 1.0)]));
            first.get_or_insert(program.nonnegative(row));
        }
        (program, first)
    }

    /// The most that the gradient could promise: its 1-norm over the natural size of the motion.
    fn reach(&self, model: &Model<D>) -> f64 {
        let of = |slope: &Nodes<D>| -> f64 {
            slope.iter().map(|node| (0..D).map(|k| node[k].abs() * self.regions[k].size).sum::<f64>()).sum()
        };
        let largest = model.pieces.iter().map(|(_, slope)| of(slope)).fold(0.0, f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    }

    fn promise(&self, a: &[SVector<f64, D>], model: &Model<D>, next: &[SVector<f64, D>]) -> f64 {
        let along = |form: &[SVector<f64, D>]| -> f64 {
            form.iter().zip(next.iter().zip(a)).map(|(form, (next, a))| form.dot(&(next - a))).sum()
        };
        let reach = self.reach(model);
        let best = model.pieces.iter().map(|(value, _)| *value).fold(f64::NEG_INFINITY, f64::max);
        let linear = model
            .pieces
            .iter()
            .map(|(value, slope)| value - best + along(slope))
            .fold(f64::NEG_INFINITY, f64::max);
        let bend: f64 = model.bends.iter().map(|bend| along(bend).powi(2) / 2.0).sum();
        -(linear + bend) / reach
    }
}

/// A convex model of the criterion around a motion.
struct Model<const D: usize> {
    /// Value and slope of each smooth piece; the model is the largest.
    pieces: Vec<(f64, Nodes<D>)>,
    /// Half the sum of the squares of these forms is the bend.
    bends: Vec<Nodes<D>>,
}

/// The same sum of squares with as few forms as its rank.
fn reduce<const D: usize>(bends: &mut Vec<Nodes<D>>) {
    let (count, nodes) = (bends.len(), bends.first().map_or(0, Vec::len));
    if count < 3 {
        return;
    }
    let forms = DMatrix::from_fn(count, nodes * D, |m, at| bends[m][at / D][at % D]);
    // the smaller of the two Gram matrices has the same rank
    let tall = count > nodes * D;
    let gram = if tall { forms.tr_mul(&forms) } else { &forms * forms.transpose() };
    let eigen = gram.symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let kept: Vec<usize> =
        (0..eigen.eigenvalues.len()).filter(|&k| eigen.eigenvalues[k] > RANK * largest).collect();
    if kept.len() == count {
        return;
    }
    *bends = kept
        .into_iter()
        .map(|k| {
            let direction = eigen.eigenvectors.column(k);
            let row = if tall { direction * eigen.eigenvalues[k].sqrt() } else { forms.tr_mul(&direction) };
            (0..nodes).map(|i| SVector::from_fn(|d, _| row[i * D + d])).collect()
        })
        .collect();
}
