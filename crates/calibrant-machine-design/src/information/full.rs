//! The information with the nuisances marginalised, and its gradient.

use super::criterion::Valued;
use super::directions::{Directions, moved};
use super::sampled::scatter;
use super::sensing::{Quadrature, of_entries};
use super::sensor_columns::{ENTRIES, entry};
use super::{Sampled, Sensing, moments};
use crate::motion::Knots;
use crate::recursion::{Dual, JointBars, Links, Moving, Number, Six, Sweep};
use calibrant_machine::chain::{ChainSensitivity, JointState, KinematicChain};
use nalgebra::{DMatrix, DVector, Vector6};

/// Its working memory.
pub(crate) struct FullInformation<'a> {
    sensing: &'a Sensing,
    directions: Directions,
    dual_links: Links<Dual<Six>>,
    pub(crate) quadrature: Quadrature,
    sampled: Sampled,
    /// `J_η` of each sample: 6 × P, row by row.
    nuisance_rows: Vec<f64>,
    sensitivity: ChainSensitivity,
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
            dual_links: Links::new(chain, &sensing.mount, &-sensing.base.specific_force),
            quadrature,
            sampled: Sampled::new(n, times),
            nuisance_rows: vec![0.0; times * 6 * directions.len()],
            directions,
            sensitivity: ChainSensitivity::new(n),
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
        let (sensing, p) = (self.sensing, self.directions.len());
        let n = sensing.links.len();
        let mut state = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        for k in 0..self.sampled.len() {
            let (joints, jerks) = (self.sampled.joints(k), self.sampled.jerks(k));
            for (j, at) in joints.iter().enumerate() {
                (state[0][j], state[1][j], state[2][j]) = (at.q, at.qd, at.qdd);
            }
            let given = JointState { positions: &state[0], velocities: &state[1], accelerations: &state[2] };
            let of = &mut self.sensitivity;
            of.evaluate(&sensing.chain, given, &sensing.base, &sensing.mount);
            let mut change = Vector6::zeros();
            for j in 0..n {
                change += of.positions.column(j) * joints[j].qd
                    + of.velocities.column(j) * joints[j].qdd
                    + of.accelerations.column(j) * jerks[j];
            }
            let after_middle_s = self.quadrature.grid.time_s(k) - self.quadrature.middle_s;
            let rows = &mut self.nuisance_rows[k * 6 * p..(k + 1) * 6 * p];
            self.directions.columns(of, &change, after_middle_s, |place, column| {
                for row in 0..6 {
                    rows[row * p + place] = column[row];
                }
            });
        }
    }

    /// `F_ηη` and `F_ηθ`.
    fn summed(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let p = self.directions.len();
        let mut nuisances = DMatrix::zeros(p, p);
        let mut cross = DMatrix::zeros(p, ENTRIES);
        let mut weighted = vec![0.0; p];
        for k in 0..self.sampled.len() {
            let weights = self.sensing.weights(&self.quadrature, &self.sampled, k);
            let phi = self.sampled.regressors(k);
            for (row, rows) in self.rows(k).chunks_exact(p.max(1)).enumerate() {
                let s = row / 3;
                for (weighted, value) in weighted.iter_mut().zip(rows) {
                    *weighted = weights[s] * value;
                }
                // the lower triangle, column by column
                for (i, value) in rows.iter().enumerate() {
                    let column = &mut nuisances.as_mut_slice()[i * p + i..(i + 1) * p];
                    for (sum, weighted) in column.iter_mut().zip(&weighted[i..]) {
                        *sum += weighted * value;
                    }
                }
                for (m, phi) in phi[s].iter().enumerate() {
                    let first = entry(s, row % 3, m) * p;
                    let column = &mut cross.as_mut_slice()[first..first + p];
                    for (sum, weighted) in column.iter_mut().zip(&weighted) {
                        *sum += weighted * phi;
                    }
                }
            }
        }
        nuisances.fill_upper_triangle_with_lower_triangle();
        (nuisances, cross)
    }

    fn rows(&self, k: usize) -> &[f64] {
        let length = 6 * self.directions.len();
        &self.nuisance_rows[k * length..(k + 1) * length]
    }

    /// The derivative by the control points, at the motion of the last value.
    pub(crate) fn gradient(&mut self, marginalised: &Marginalised) -> DMatrix<f64> {
        let (sensing, p) = (self.sensing, self.directions.len());
        let n = sensing.links.len();
        let omega = sensing.columns.of_entries(&marginalised.valued.omega);
        let extended = extended(&omega, &marginalised.gain);
        let mut gradient = DMatrix::zeros(self.quadrature.grid.knots.controls(), n);
        let mut bars = vec![JointBars { q: 0.0, qd: 0.0, qdd: 0.0 }; n];
        let zero = Dual::<Six>::of(0.0);
        let mut dual_bars = vec![JointBars { q: zero, qd: zero, qdd: zero }; n];
        let mut sweep = Sweep::new(n);
        let mut positions = vec![Six::of(0.0); n];
        let mut dual_joints = Vec::with_capacity(n);
        let mut g = vec![DVector::zeros(ENTRIES + p); 6];
        let seed = |row: usize, s: usize| {
            Dual::new(if row / 3 == s { Six::unit(row) } else { Six::of(0.0) }, Six::of(0.0))
        };
        let seeds = Moving {
            a: crate::recursion::V([seed(0, 0), seed(1, 0), seed(2, 0)]),
            w: crate::recursion::V([seed(3, 1), seed(4, 1), seed(5, 1)]),
            ..Moving::zero()
        };
        for k in 0..self.sampled.len() {
            let (joints, jerks) = (self.sampled.joints(k), self.sampled.jerks(k));
            let weights = sensing.weights(&self.quadrature, &self.sampled, k);
            let phi = self.sampled.regressors(k);
            let (mut bar, mut told) = (Moving::zero(), 0.0);
            for (row, g) in g.iter_mut().enumerate() {
                let (s, i) = (row / 3, row % 3);
                let nuisance_row = &self.rows(k)[row * p..(row + 1) * p];
                multiply(&extended, entry(s, i, 0), &phi[s], nuisance_row, g);
                let first = entry(s, i, 0);
                told += weights[s]
                    * (g.as_slice()[first..first + 4]
                        .iter()
                        .zip(&phi[s])
                        .map(|(g, phi)| g * phi)
                        .sum::<f64>()
                        + g.as_slice()[ENTRIES..].iter().zip(nuisance_row).map(|(g, j)| g * j).sum::<f64>());
                let reading = if s == 0 { &mut bar.a } else { &mut bar.w };
                for m in 0..3 {
                    reading.0[m] -= 2.0 * weights[s] * g[first + 1 + m];
                }
            }
            self.sampled.sweep(k).reverse(&sensing.links, joints, bar, &mut bars);

            if p == 0 {
                for (j, bar) in bars.iter().enumerate() {
                    let of_growth = told * sensing.growth.slope(joints, j);
                    scatter(
                        &mut gradient,
                        &self.quadrature.grid,
                        k,
                        j,
                        [bar.q, bar.qd + of_growth, bar.qdd, 0.0],
                    );
                }
                continue;
            }
            let after_middle_s = self.quadrature.grid.time_s(k) - self.quadrature.middle_s;
            let combination = |place: usize| {
                Six(std::array::from_fn(|row| -2.0 * weights[row / 3] * g[row][ENTRIES + place]))
            };
            let time =
                self.directions.combined(combination, after_middle_s, &mut self.dual_links, &mut positions);
            dual_joints.clear();
            for (j, at) in joints.iter().enumerate() {
                dual_joints.push(moved(at, jerks[j], positions[j], time));
            }
            sweep.forward(&self.dual_links, &dual_joints);
            sweep.reverse(&self.dual_links, &dual_joints, seeds, &mut dual_bars);
            for j in 0..n {
                let JointBars { q, qd, qdd } = dual_bars[j];
                // the direction in time moves with the motion, too
                let all = [
                    bars[j].q + q.slope.sum(),
                    bars[j].qd + (qd.slope + time * q.value).sum() + told * sensing.growth.slope(joints, j),
                    bars[j].qdd + (qdd.slope + time * qd.value).sum(),
                    (time * qdd.value).sum(),
                ];
                scatter(&mut gradient, &self.quadrature.grid, k, j, all);
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

/// `Ω̂ = E Ω Eᵀ`, `E = (I, −K)`.
fn extended(omega: &DMatrix<f64>, gain: &DMatrix<f64>) -> DMatrix<f64> {
    let p = gain.nrows();
    let mut extended = DMatrix::zeros(ENTRIES + p, ENTRIES + p);
    let below = -(gain * omega);
    extended.view_mut((0, 0), (ENTRIES, ENTRIES)).copy_from(omega);
    extended.view_mut((ENTRIES, 0), (p, ENTRIES)).copy_from(&below);
    extended.view_mut((0, ENTRIES), (ENTRIES, p)).copy_from(&below.transpose());
    extended.view_mut((ENTRIES, ENTRIES), (p, p)).copy_from(&-(below * gain.transpose()));
    extended
}

/// `Ω̂ Jᵀ` of a row whose entries `φ` are from `first` on.
fn multiply(extended: &DMatrix<f64>, first: usize, phi: &[f64; 4], nuisances: &[f64], g: &mut DVector<f64>) {
    let size = extended.nrows();
    let g = g.as_mut_slice();
    g.fill(0.0);
    let mut add = |column: usize, factor: f64| {
        let column = &extended.as_slice()[column * size..(column + 1) * size];
        for (g, value) in g.iter_mut().zip(column) {
            *g += factor * value;
        }
    };
    for (m, factor) in phi.iter().enumerate() {
        add(first + m, *factor);
    }
    for (place, factor) in nuisances.iter().enumerate() {
        add(ENTRIES + place, *factor);
    }
}
