//! The information with the nuisances marginalised, and its gradient.

use super::criterion::Valued;
use super::directions::Directions;
use super::sampled::scatter;
use super::sensing::{Quadrature, of_entries};
use super::sensor_columns::{ENTRIES, entry};
use super::{Sampled, Sensing, moments};
use crate::motion::Knots;
use crate::recursion::{Contraction, JointBars, Moving, V};
use calibrant_machine::chain::KinematicChain;
use nalgebra::DMatrix;

/// Its working memory.
pub(crate) struct FullInformation<'a> {
    sensing: &'a Sensing,
    directions: Directions,
    pub(crate) quadrature: Quadrature,
    sampled: Sampled,
    /// `J_ηᵀ`: a column for each sample and row of a reading.
    columns: DMatrix<f64>,
    contraction: Contraction,
}

/// The information of entries and nuisances, and what follows from it.
pub(crate) struct Marginalised {
    /// The criterion at the information of the parameters.
    pub(crate) valued: Valued,
    /// Information on the parameters.
    pub(crate) information: DMatrix<f64>,
    /// `F_ηη`, without priors.
    pub(crate) nuisances: DMatrix<f64>,
    /// `K = (F_ηη + P)⁻¹ F_ηθ` by the 24 entries.
    pub(crate) gain: DMatrix<f64>,
}

impl<'a> FullInformation<'a> {
    pub(crate) fn new(sensing: &'a Sensing, chain: &KinematicChain, knots: Knots, points: usize) -> Self {
        let quadrature = Quadrature::new(knots, points);
        let (n, times) = (sensing.links.len(), quadrature.grid.len());
        let tip = chain.tip_transform.rotation.to_rotation_matrix().into_inner();
        let directions = Directions::new(sensing, &tip);
        Self {
            sensing,
            quadrature,
            sampled: Sampled::new(n, times),
            columns: DMatrix::zeros(directions.len(), 6 * times),
            directions,
            contraction: Contraction::new(n),
        }
    }

    /// The criterion at a motion.
    pub(crate) fn at(&mut self, controls: &DMatrix<f64>) -> Option<Marginalised> {
        self.sampled.fill(&self.sensing.links, &self.quadrature.grid, controls);
        self.differentiate();
        let (nuisances, gain, information) = self.marginal()?;
        let valued = self.sensing.criterion.at(&information)?;
        Some(Marginalised { valued, information, nuisances, gain })
    }

    /// The information on the parameters at the motion of the last value, which may be singular.
    pub(crate) fn information(&self) -> Option<DMatrix<f64>> {
        self.marginal().map(|(_, _, information)| information)
    }

    /// `F_ηη`, `K` and the information on the parameters.
    fn marginal(&self) -> Option<(DMatrix<f64>, DMatrix<f64>, DMatrix<f64>)> {
        let (nuisances, cross) = self.summed();
        let columns = &self.sensing.columns;
        let p = columns.len();
        let prior = self.sensing.layout.prior.view((p, p), nuisances.shape());
        let gain = solved(&(&nuisances + prior), &cross)?;
        let marginal =
            of_entries(&moments(self.sensing, &self.quadrature, &self.sampled)) - cross.tr_mul(&gain);
        let marginal = (&marginal + marginal.transpose()) * 0.5;
        let information = columns.of_parameters(&marginal) + self.sensing.sensor_prior();
        Some((nuisances, gain, information))
    }

    /// `J_η` of each sample.
    fn differentiate(&mut self) {
        if self.directions.len() == 0 {
            return;
        }
        self.sampled.thirds(&self.sensing.links);
        for k in 0..self.sampled.len() {
            let mut columns = self.columns.columns_mut(6 * k, 6);
            let after_middle_s = self.quadrature.after_middle_s(k);
            self.directions.columns(self.sampled.sweep(k), after_middle_s, |place, [force, rate]| {
                for row in 0..3 {
                    columns[(place, row)] = force.0[row];
                    columns[(place, 3 + row)] = rate.0[row];
                }
            });
        }
    }

    /// `F_ηη` and `F_ηθ`.
    fn summed(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let p = self.directions.len();
        let mut weighted = self.columns.transpose();
        let mut cross = DMatrix::zeros(p, ENTRIES);
        for k in 0..self.sampled.len() {
            let weights = self.sensing.weights(&self.quadrature, &self.sampled, k);
            let phi = self.sampled.regressors(k);
            for row in 0..6 {
                let s = row / 3;
                let column = self.columns.column(6 * k + row);
                for (m, phi) in phi[s].iter().enumerate() {
                    cross.column_mut(entry(s, row % 3, m)).axpy(weights[s] * phi, &column, 1.0);
                }
                weighted.row_mut(6 * k + row).scale_mut(weights[s]);
            }
        }
        (&self.columns * weighted, cross)
    }

    /// The derivative by the control points, at the motion of the last value.
    pub(crate) fn gradient(&mut self, marginalised: &Marginalised) -> DMatrix<f64> {
        let Self { sensing, directions, quadrature, sampled, columns, contraction } = self;
        let (n, gain) = (sensing.links.len(), &marginalised.gain);
        let omega = sensing.columns.of_entries(&marginalised.valued.omega);
        // Eᵀ Jᵀ = (I, −Kᵀ) Jᵀ, then Ω of it, then G_η = −K of that
        let mut own = -gain.transpose() * &*columns;
        for k in 0..sampled.len() {
            for (row, phi) in sampled.regressors(k).iter().flat_map(|phi| [phi; 3]).enumerate() {
                let mut column = own.column_mut(6 * k + row);
                for (m, phi) in phi.iter().enumerate() {
                    column[entry(row / 3, row % 3, m)] += phi;
                }
            }
        }
        let of_entries = omega * &own;
        let of_nuisances = -gain * &of_entries;
        let mut gradient = DMatrix::zeros(quadrature.grid.knots.controls(), n);
        let mut bars = vec![JointBars::ZERO; n];
        let mut of_jerks = vec![0.0; n];
        for k in 0..sampled.len() {
            let (joints, sweep) = (sampled.joints(k), sampled.sweep(k));
            let weights = sensing.weights(quadrature, sampled, k);
            let (mut readings, mut told) = ([V::ZERO; 2], 0.0);
            for row in 0..6 {
                let (s, i) = (row / 3, row % 3);
                let g = of_entries.column(6 * k + row);
                told += weights[s] * g.dot(&own.column(6 * k + row));
                for m in 0..3 {
                    readings[s].0[m] -= 2.0 * weights[s] * g[entry(s, i, 1 + m)];
                }
            }
            bars.fill(JointBars::ZERO);
            of_jerks.fill(0.0);
            if directions.len() == 0 {
                sweep.reverse(&sensing.links, joints, &readings, |_| Moving::ZERO, &mut bars);
            } else {
                let g = of_nuisances.columns(6 * k, 6);
                let factors =
                    |place: usize| [0, 1, 2, 3, 4, 5].map(|row| -2.0 * weights[row / 3] * g[(place, row)]);
                directions.combine(factors, quadrature.after_middle_s(k), contraction);
                let out = (&mut bars[..], &mut of_jerks[..]);
                contraction.differentiate(sweep, &sensing.links, joints, &readings, out);
            }
            let growth = sensing.growth.at(joints);
            for (j, bar) in bars.iter().enumerate() {
                let all = [bar.q, bar.qd + told * growth.slope(joints, j), bar.qdd, of_jerks[j]];
                scatter(&mut gradient, &quadrature.grid, k, j, all);
            }
        }
        gradient
    }
}

/// `A⁻¹ B` for a positive definite `A`, scaled to a unit diagonal.
pub(crate) fn solved(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let size = a.nrows();
    if size == 0 {
        return Some(DMatrix::zeros(0, b.ncols()));
    }
    let scale: Vec<f64> = a.diagonal().iter().map(|d| 1.0 / d.sqrt()).collect();
    let factor = DMatrix::from_fn(size, size, |i, j| a[(i, j)] * scale[i] * scale[j]).cholesky()?;
    let mut solution = DMatrix::from_fn(size, b.ncols(), |i, j| b[(i, j)] * scale[i]);
    factor.solve_mut(&mut solution);
    for (i, mut row) in solution.row_iter_mut().enumerate() {
        row *= scale[i];
    }
    Some(solution)
}
