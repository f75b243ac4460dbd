//! The least squares of a chain.
//!
//! ```text
//! minimise over p, a:  ½ Σ_k ‖y_k − S α(t_k; a) − b‖²_W + ½ Σ_i (a_{i+1} − a_i − Δ_i)²/q_i + prior
//! ```
//!
//! For given parameters the motion is a linear problem.

use super::interval_moments::Moments;
use crate::arrowhead::{Arrowhead, Increment, Link, Undetermined};
use crate::estimate::CalibrationSettings;
use crate::information::chain_model as model;
use crate::solve::{Equations, LeastSquares, LoopSettings, Minimum, minimise};
use nalgebra::{SMatrix, SVector};

/// One chain: D readings, P = D (D + 1) parameters.
pub(super) struct Chain<const D: usize, const P: usize> {
    /// Moments of each interval about `reference`.
    pub(super) moments: Vec<Moments<D>>,
    /// Reference reading `z` at each node.
    pub(super) reference: Vec<SVector<f64, D>>,
    /// Inverse variance of a sample.
    pub(super) weight: SVector<f64, D>,
    /// Variance `q_i` of each increment.
    pub(super) variance: Vec<SVector<f64, D>>,
    /// Commanded increment `Δ_i`.
    pub(super) commanded: Vec<SVector<f64, D>>,
    /// Is node i+1 known? (Node 0 always is.)
    pub(super) fixed: Vec<[bool; D]>,
    /// Prior on the parameters: mean and inverse variance.
    pub(super) prior: Option<(SVector<f64, P>, SVector<f64, P>)>,
    /// Is every increment known exactly? Then there is no chain to eliminate.
    pub(super) rigid: bool,
}

/// Length of a step, in standard deviations, below which it is rounding as soon as it no longer halves.
const SHORT: f64 = 1e-6;
/// Length of a step, in standard deviations, below which it is rounding if it has not halved for three iterations.
///
/// This occurs with a million samples in few intervals: χ² then no longer distinguishes steps.
const STEADY: f64 = 1e-4;

/// Parameters and motion.
#[derive(Clone)]
pub(super) struct State<const D: usize, const P: usize> {
    pub(super) p: SVector<f64, P>,
    pub(super) a: Vec<SVector<f64, D>>,
}

/// The end of the iteration.
pub(super) type Fit<const D: usize, const P: usize> = Minimum<State<D, P>, D, P>;

impl<const D: usize, const P: usize> Chain<D, P> {
    /// Normal equations of one interval at a state.
    fn link(&self, i: usize, state: &State<D, P>) -> Link<D, P> {
        let m = &self.moments[i];
        let (a0, a1) = (&state.a[i], &state.a[i + 1]);
        let s = model::matrix(&state.p);
        let (r0, r1) = self.residuals(i, state);
        let sws = SMatrix::<f64, D, D>::from_fn(|i, j| {
            (0..D).map(|row| s[(row, i)] * self.weight[row] * s[(row, j)]).sum()
        });
        Link {
            h00: sws * m.m00,
            h01: sws * m.m01,
            h11: sws * m.m11,
            b0: model::coupling(&s, &self.weight, [m.m00, m.m01], a0, a1),
            b1: model::coupling(&s, &self.weight, [m.m01, m.m11], a0, a1),
            c: model::information(&self.weight, [m.m00, m.m01, m.m11], a0, a1),
            g0: s.tr_mul(&r0),
            g1: s.tr_mul(&r1),
            gp: model::gradient(a0, &r0, a1, &r1),
        }
    }

    /// Weighted residual sums `W Σ (1 − λ) r` and `W Σ λ r` of one interval.
    fn residuals(&self, i: usize, state: &State<D, P>) -> (SVector<f64, D>, SVector<f64, D>) {
        let m = &self.moments[i];
        let d0 = model::reading(&state.p, &state.a[i]) - self.reference[i];
        let d1 = model::reading(&state.p, &state.a[i + 1]) - self.reference[i + 1];
        (
            (m.e0 - d0 * m.m00 - d1 * m.m01).component_mul(&self.weight),
            (m.e1 - d0 * m.m01 - d1 * m.m11).component_mul(&self.weight),
        )
    }

    fn increment(&self, i: usize, state: &State<D, P>) -> Increment<D> {
        Increment {
            variance: self.variance[i],
            residual: self.commanded[i] - (state.a[i + 1] - state.a[i]),
            fixed: self.fixed[i],
        }
    }

    /// The system factored at a state, and the diagonal of the border's information before the chain was eliminated.
    pub(super) fn factor(&self, state: &State<D, P>) -> Result<Equations<D, P>, Undetermined> {
        if self.rigid {
            let system = self.as_commanded(state);
            let unreduced = system.information.diagonal();
            return Ok((system, unreduced));
        }
        let (border, rhs) = self.prior_equations(state);
        let mut unreduced = border.diagonal();
        let link = |i| {
            let link = self.link(i, state);
            unreduced += link.c.diagonal();
            link
        };
        let system =
            Arrowhead::eliminate(self.moments.len(), link, |i| self.increment(i, state), border, rhs)?;
        Ok((system, unreduced))
    }

    /// The equations of the parameters and of the clock behind them (Q = P + 2), without the motion. `nodes_s` are the times of the nodes from the middle of
    /// the motion.
    pub(super) fn clock_equations<const Q: usize>(
        &self,
        state: &State<D, P>,
        nodes_s: &[f64],
    ) -> Result<(SMatrix<f64, Q, Q>, SVector<f64, Q>), Undetermined> {
        let s = model::matrix(&state.p);
        let link = |i: usize| {
            let (m, times) = (&self.moments[i], [nodes_s[i], nodes_s[i + 1]]);
            let nodes = [&state.a[i], &state.a[i + 1]];
            let jerk = (nodes[1] - nodes[0]) / (times[1] - times[0]);
            let clock = model::clock_sensitivity(&s, &jerk, times);
            let (r0, r1) = self.residuals(i, state);
            let m = [m.m00, m.m01, m.m11];
            model::with_clock::<D, P, Q>(&self.link(i, state), &s, &self.weight, m, nodes, &clock, [&r0, &r1])
        };
        let (prior, prior_rhs) = self.prior_equations(state);
        let (mut border, mut rhs) = (SMatrix::<f64, Q, Q>::zeros(), SVector::<f64, Q>::zeros());
        border.fixed_view_mut::<P, P>(0, 0).copy_from(&prior);
        rhs.fixed_rows_mut::<P>(0).copy_from(&prior_rhs);
        let intervals = self.moments.len();
        if self.rigid {
            for link in (0..intervals).map(link) {
                border += link.c;
                rhs += link.gp;
            }
            return Ok((border, rhs));
        }
        let system = Arrowhead::eliminate(intervals, link, |i| self.increment(i, state), border, rhs)?;
        Ok((system.information, system.rhs))
    }

    /// The equations of the parameters alone, the motion as it is in `state`.
    pub(super) fn as_commanded(&self, state: &State<D, P>) -> Arrowhead<D, P> {
        let (mut information, mut rhs) = self.prior_equations(state);
        for (i, m) in self.moments.iter().enumerate() {
            let (a0, a1) = (&state.a[i], &state.a[i + 1]);
            let (r0, r1) = self.residuals(i, state);
            information += model::information::<D, P>(&self.weight, [m.m00, m.m01, m.m11], a0, a1);
            rhs += model::gradient::<D, P>(a0, &r0, a1, &r1);
        }
        Arrowhead::rigid(self.moments.len(), information, rhs)
    }

    /// What the prior adds to the equations of the parameters.
    fn prior_equations(&self, state: &State<D, P>) -> (SMatrix<f64, P, P>, SVector<f64, P>) {
        match &self.prior {
            Some((mean, weight)) => (SMatrix::from_diagonal(weight), (mean - state.p).component_mul(weight)),
            None => (SMatrix::zeros(), SVector::zeros()),
        }
    }

    /// Iterates from a state with its equations.
    pub(super) fn fit(
        &self,
        state: State<D, P>,
        equations: Equations<D, P>,
        settings: &CalibrationSettings,
    ) -> Fit<D, P> {
        let settings = LoopSettings {
            most: settings.max_iterations,
            tolerance: settings.tolerance,
            rounding: &[(SHORT, 1), (STEADY, 3)],
            untested_below: STEADY,
            least_chi2: 1.0,
            damping: [1e-3, 1e12],
            has_last_step: true,
        };
        minimise(self, state, equations, &settings)
    }
}

impl<const D: usize, const P: usize> LeastSquares<D, P> for Chain<D, P> {
    type Point = State<D, P>;

    /// χ² of the data, the process noise and the prior.
    fn chi2(&self, state: &State<D, P>) -> f64 {
        let mut chi2 = 0.0;
        let mut d0 = model::reading(&state.p, &state.a[0]) - self.reference[0];
        for (i, m) in self.moments.iter().enumerate() {
            let d1 = model::reading(&state.p, &state.a[i + 1]) - self.reference[i + 1];
            let increment = self.commanded[i] - (state.a[i + 1] - state.a[i]);
            for axis in 0..D {
                let (x0, x1) = (d0[axis], d1[axis]);
                let squares = m.e2[axis] - 2.0 * (x0 * m.e0[axis] + x1 * m.e1[axis])
                    + m.m00 * x0 * x0
                    + 2.0 * m.m01 * x0 * x1
                    + m.m11 * x1 * x1;
                chi2 += self.weight[axis] * squares;
                let q = self.variance[i][axis];
                if q > 0.0 && q.is_finite() {
                    chi2 += increment[axis] * increment[axis] / q;
                }
            }
            d0 = d1;
        }
        if let Some((mean, weight)) = &self.prior {
            chi2 += (mean - state.p).component_mul(&(mean - state.p)).dot(weight);
        }
        chi2
    }

    fn equations(&self, state: &State<D, P>) -> Option<Equations<D, P>> {
        self.factor(state).ok()
    }

    fn moved(
        &self,
        state: &State<D, P>,
        system: &Arrowhead<D, P>,
        step: &SVector<f64, P>,
    ) -> Option<State<D, P>> {
        let a = state.a.iter().zip(system.chain_step(step)).map(|(a, step)| a + step).collect();
        Some(State { p: state.p + step, a })
    }

    /// A step of parameters and motion together may leave the curved valley. For given parameters the motion is a linear problem, solved in one step.
    fn followed(&self, mut state: State<D, P>) -> Option<State<D, P>> {
        let (system, _) = self.factor(&state).ok()?;
        for (a, step) in state.a.iter_mut().zip(system.chain_step(&SVector::zeros())) {
            *a += step;
        }
        Some(state)
    }
}
