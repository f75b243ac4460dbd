//! How the clock takes part in a change of the parameters: `U Bᵀ` of [`clock_marginal`](super::clock_marginal).

use crate::motion::MotionClock;
use nalgebra::{DMatrix, Matrix2, RowVector2, SMatrix, SVector};

/// Parameters and clock of the largest part: a border of one size for all.
pub(super) const BORDER: usize = 14;

/// The part of delay and rate in what remains of a change of the parameters.
#[derive(Debug, Clone)]
pub(super) struct ClockResponse<const D: usize, const P: usize> {
    /// `B`.
    pub(super) regression: SMatrix<f64, P, 2>,
    /// `S j` of each interval.
    pub(super) moved: Vec<SVector<f64, D>>,
    /// `s` of each node, s.
    pub(super) nodes_s: Vec<f64>,
}

impl<const D: usize, const P: usize> ClockResponse<D, P> {
    /// What the clock takes of the remaining sensitivity at both ends of an interval: `U Bᵀ`.
    pub(super) fn of_interval(&self, i: usize) -> [SMatrix<f64, D, P>; 2] {
        [i, i + 1].map(|node| self.moved[i] * (self.lever(node) * self.regression.transpose()))
    }

    /// `(1, s)` at a node.
    fn lever(&self, node: usize) -> RowVector2<f64> {
        RowVector2::new(1.0, self.nodes_s[node])
    }

    /// `Σ_k R_k Ω B (1, s_k)ᵀ` of an interval with the sample sums `m`, from `R Ω` at its ends.
    pub(super) fn pulled(&self, i: usize, felt: &[SMatrix<f64, D, P>; 2], m: [f64; 3]) -> SVector<f64, D> {
        let (y0, y1) = (felt[0] * self.regression, felt[1] * self.regression);
        let (t0, t1) = (self.lever(i).transpose(), self.lever(i + 1).transpose());
        y0 * t0 * m[0] + (y0 * t1 + y1 * t0) * m[1] + y1 * t1 * m[2]
    }

    /// `B Σ_k (1, s_k)ᵀ (w R_k)` of an interval, from `w R` at its ends.
    pub(super) fn form(&self, i: usize, felt: [SMatrix<f64, 1, P>; 2], m: [f64; 3]) -> SMatrix<f64, P, P> {
        let (t0, t1) = (self.lever(i).transpose(), self.lever(i + 1).transpose());
        let sum = t0 * (felt[0] * m[0] + felt[1] * m[1]) + t1 * (felt[0] * m[1] + felt[1] * m[2]);
        self.regression * sum
    }
}

/// The information of parameters and clock, with the clock last, with what is known of it. What is exact has no part: its variance is 1, and shared with nothing.
pub(crate) fn with_known_clock(mut joint: DMatrix<f64>, clock: &MotionClock) -> DMatrix<f64> {
    let p = joint.nrows() - 2;
    for (k, sd) in [(p, clock.delay_sd_s), (p + 1, clock.rate_sd)] {
        if sd > 0.0 {
            joint[(k, k)] += sd.powi(-2);
        } else {
            joint.row_mut(k).fill(0.0);
            joint.column_mut(k).fill(0.0);
            joint[(k, k)] = 1.0;
        }
    }
    joint
}

/// The information of the parameters with the clock marginalised, from that of both with the clock last.
pub(super) fn marginal(joint: &DMatrix<f64>, clock: &MotionClock) -> (DMatrix<f64>, DMatrix<f64>) {
    let p = joint.nrows() - 2;
    let joint = with_known_clock(joint.clone(), clock);
    let own = Matrix2::from_fn(|i, j| joint[(p + i, p + j)]);
    let cross = joint.view((0, p), (p, 2)).into_owned();
    let inverse = own.try_inverse().unwrap_or_else(Matrix2::zeros);
    let regression = &cross * DMatrix::from_fn(2, 2, |i, j| inverse[(i, j)]);
    let information = joint.view((0, 0), (p, p)) - &regression * cross.transpose();
    ((&information + information.transpose()) * 0.5, regression)
}
