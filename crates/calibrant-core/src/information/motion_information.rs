//! The information that a recording of a motion will give on the parameters, and its derivative with respect
//! to the motion.
//!
//! The residuals are zero on average. The normal equations of the estimation problem then give the Fisher
//! information of the parameters, with the motion marginalised. `G(a)` is the sensitivity of the readings to
//! the parameters. `A` is the response of the estimated motion to a change of the parameters. `R = G + S A`
//! is what remains of that change in the readings. With `W_i = A_{i+1} − A_i`,
//!
//! `F = min over A:  Σ_k R_kᵀ Σ_ν⁻¹ R_k + Σ_i W_iᵀ Q_i⁻¹ W_i`
//!
//! (a minimum of matrices: `A` minimises in every direction at once). For trust `known`, `A = 0`. For
//! `noisy`, `Q_i = diag(σ_u(u_i)² Δτ_i²)`. For `unknown`, `Q_i = ∞` and the ends are fixed.
//!
//! The clock of the recording is marginalised as well ([`clock_marginal`](super::clock_marginal)).
//!
//! # Derivative
//! `A` minimises, so the derivative may keep it constant (envelope theorem). For a symmetric `Ω`,
//!
//! `d⟨Ω, F⟩ = 2 Σ_k ⟨Σ_ν⁻¹ R_k Ω, dG_k⟩ − Σ_i ⟨ψ_i Ω ψ_iᵀ, dQ_i⟩`, `ψ_i = Q_i⁻¹ W_i`
//!
//! The costate `ψ` is the force of the readings after interval i on its increment, found without dividing by
//! `Q`. `F` is matrix convex in the motion for given `Q` (quadratic over linear) and falls with `Q`. So its
//! linearisation gives a lower bound, on which the solver of the design is built.
//!
//! # Cost
//! `O(N)` for the factorisation, and again for each derivative.

use super::chain_model as model;
use super::clock_response::ClockResponse;
use crate::arrowhead::{Arrowhead, Increment, Link};
use crate::error::{Error, Result, UndeterminedGroup};
use crate::motion::{IntervalSums, JerkControlledMotion, KnownEnds, MotionClock, Trust};
use nalgebra::{DMatrix, SMatrix, SVector, Vector3};

/// The conditions of axes that are estimated together: one axis (P = 2), or all three of a full sensor (P =
/// 12, sorted by reading).
#[derive(Debug, Clone)]
pub struct PartInformation<const D: usize, const P: usize> {
    /// The axes.
    pub axes: [usize; D],
    /// Places of its parameters in the parameter list.
    pub slots: [usize; P],
    /// Breakpoints, s.
    pub tau: Vec<f64>,
    /// Samples of each interval.
    pub sums: Vec<IntervalSums>,
    pub(super) weight: SVector<f64, D>,
    pub(super) s: SMatrix<f64, D, D>,
    pub(super) trust: Trust,
    pub(super) known_ends: KnownEnds,
    pub(super) clock: MotionClock,
}

fn undetermined_motion() -> Error {
    Error::undetermined(UndeterminedGroup {
        parameters: Vec::new(),
        free_combinations: 0,
        reason: "the samples do not determine the motion in between its ends".into(),
        remedy: "sample faster, or use fewer intervals".into(),
    })
}

/// The information at a motion, and the terms that its derivative needs.
#[derive(Debug, Clone)]
pub struct Linearised<const D: usize, const P: usize> {
    /// Information `F`.
    pub information: SMatrix<f64, P, P>,
    /// The remaining sensitivity `R` of the readings at each node to the parameters.
    pub(super) residual: Vec<SMatrix<f64, D, P>>,
    /// Costate `ψ` of each interval; empty unless the motion is noisy.
    pub(super) costate: Vec<SMatrix<f64, D, P>>,
    /// What the clock takes of `R`; `None` where it is exact.
    pub(super) clock: Option<ClockResponse<D, P>>,
}

impl<const D: usize, const P: usize> Linearised<D, P> {
    /// The remaining sensitivity of the readings at both ends of an interval. The clock's part differs on both sides of a node.
    pub(super) fn ends(&self, i: usize) -> [SMatrix<f64, D, P>; 2] {
        let ends = [self.residual[i], self.residual[i + 1]];
        let Some(clock) = &self.clock else { return ends };
        let [first, last] = clock.of_interval(i);
        [ends[0] - first, ends[1] - last]
    }
}

/// Derivative of `⟨Ω, F⟩`.
#[derive(Debug, Clone)]
pub struct InformationDerivative<const D: usize> {
    /// With respect to the nodes' accelerations, at constant variances of the increments.
    pub nodes: Vec<SVector<f64, D>>,
    /// With respect to the variances of the increments; zero unless the motion is noisy. Never positive for `Ω ⪰ 0`.
    pub variances: Vec<SVector<f64, D>>,
}

impl<const D: usize, const P: usize> PartInformation<D, P> {
    /// Number of intervals.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.sums.len()
    }

    /// Duration of interval i, s.
    #[must_use]
    pub fn interval_s(&self, i: usize) -> f64 {
        self.tau[i + 1] - self.tau[i]
    }

    /// Does a motion give the same information under both conditions?
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        (&self.tau, &self.sums, &self.weight, &self.s) == (&other.tau, &other.sums, &other.weight, &other.s)
            && (self.trust, self.known_ends, self.clock) == (other.trust, other.known_ends, other.clock)
    }

    /// How far the motion is trusted.
    #[must_use]
    pub fn trust(&self) -> Trust {
        self.trust
    }

    /// Process noise `σ_u(u) = floor + ratio |u|`, where the motion is noisy: (floor, ratio).
    #[must_use]
    pub fn input_noise(&self) -> Option<(f64, f64)> {
        if let Trust::Noisy(noise) = self.trust { Some((noise.floor_mps3, noise.ratio)) } else { None }
    }

    /// The nodes of a motion on these axes.
    #[must_use]
    pub fn nodes(&self, motion: &JerkControlledMotion) -> Vec<SVector<f64, D>> {
        motion.acceleration_mps2().iter().map(|a| SVector::from_fn(|k, _| a[self.axes[k]])).collect()
    }

    /// Adds the derivative of `⟨Ω, F⟩` with respect to all nodes of a motion, `Ω` for all parameters.
    pub(super) fn add_derivative(
        &self,
        motion: &JerkControlledMotion,
        omega: &DMatrix<f64>,
        gradient: &mut [Vector3<f64>],
    ) -> Result<()> {
        let nodes = self.nodes(motion);
        let own = SMatrix::from_fn(|i, j| omega[(self.slots[i], self.slots[j])]);
        let at = self.determined(&nodes)?;
        for (sum, part) in gradient.iter_mut().zip(self.total(&nodes, &self.derivative(&at, &own))) {
            for (k, &axis) in self.axes.iter().enumerate() {
                sum[axis] += part[k];
            }
        }
        Ok(())
    }

    /// The information at a motion.
    pub(super) fn at(&self, motion: &JerkControlledMotion) -> Result<SMatrix<f64, P, P>> {
        self.determined(&self.nodes(motion)).map(|at| at.information)
    }

    /// The information of parameters and clock at a motion, and the places of the parameters.
    pub(super) fn joint_at(&self, motion: &JerkControlledMotion) -> Result<(DMatrix<f64>, Vec<usize>)> {
        let joint = self.joint_with_clock(&self.nodes(motion)).ok_or_else(undetermined_motion)?;
        Ok((joint, self.slots.to_vec()))
    }

    fn determined(&self, nodes: &[SVector<f64, D>]) -> Result<Linearised<D, P>> {
        self.linearise(nodes).ok_or_else(undetermined_motion)
    }

    /// The information at a motion. `None` where the samples leave a node of an unknown motion undetermined.
    #[must_use]
    pub fn linearise(&self, a: &[SVector<f64, D>]) -> Option<Linearised<D, P>> {
        if !self.clock.is_exact() {
            return self.linearise_with_clock(a);
        }
        if self.trust == Trust::Known {
            let mut information = SMatrix::zeros();
            for (m, a) in self.sums.iter().zip(a.windows(2)) {
                information += model::information::<D, P>(&self.weight, [m.m00, m.m01, m.m11], &a[0], &a[1]);
            }
            let residual = a.iter().map(model::sensitivity).collect();
            return Some(Linearised { information, residual, costate: Vec::new(), clock: None });
        }
        let increments = self.increments(a);
        let system = Arrowhead::eliminate(
            self.intervals(),
            |i| self.link(i, a),
            |i| increments[i].clone(),
            SMatrix::zeros(),
            SVector::zeros(),
        )
        .ok()?;
        let mut residual: Vec<SMatrix<f64, D, P>> = a.iter().map(model::sensitivity).collect();
        for parameter in 0..P {
            let response = system.chain_step(&SVector::from_fn(|k, _| f64::from(u8::from(k == parameter))));
            for (r, step) in residual.iter_mut().zip(&response) {
                let column = r.column(parameter) + self.s * step;
                r.set_column(parameter, &column);
            }
        }
        let mut at =
            Linearised { information: system.information, residual, costate: Vec::new(), clock: None };
        if let Trust::Noisy(_) = self.trust {
            at.costate = self.costate(&at, &increments);
        }
        Some(at)
    }

    /// The normal equations of one interval.
    pub(super) fn link(&self, i: usize, a: &[SVector<f64, D>]) -> Link<D, P> {
        let sws = self.s.tr_mul(&SMatrix::from_diagonal(&self.weight)) * self.s;
        let m = &self.sums[i];
        Link {
            h00: sws * m.m00,
            h01: sws * m.m01,
            h11: sws * m.m11,
            b0: model::coupling(&self.s, &self.weight, [m.m00, m.m01], &a[i], &a[i + 1]),
            b1: model::coupling(&self.s, &self.weight, [m.m01, m.m11], &a[i], &a[i + 1]),
            c: model::information(&self.weight, [m.m00, m.m01, m.m11], &a[i], &a[i + 1]),
            g0: SVector::zeros(),
            g1: SVector::zeros(),
            gp: SVector::zeros(),
        }
    }

    /// The force of the readings at and after each interval's end on its increment, less the force that fixes
    /// a known end.
    pub(super) fn costate(
        &self,
        at: &Linearised<D, P>,
        increments: &[Increment<D>],
    ) -> Vec<SMatrix<f64, D, P>> {
        let sw = self.s.tr_mul(&SMatrix::from_diagonal(&self.weight));
        let mut force = SMatrix::<f64, D, P>::zeros();
        let mut costate = vec![force; self.intervals()];
        for i in (0..self.intervals()).rev() {
            let m = &self.sums[i];
            let [first, last] = at.ends(i);
            costate[i] = force - sw * (first * m.m01 + last * m.m11);
            force -= sw * (first * (m.m00 + m.m01) + last * (m.m01 + m.m11));
        }
        if self.known_ends == KnownEnds::Both {
            // Σ W = 0: the force that fixes the end makes Σ Q ψ vanish
            for k in 0..D {
                let total: f64 = increments.iter().map(|increment| increment.variance[k]).sum();
                if total > 0.0 {
                    let mut mean = SMatrix::<f64, 1, P>::zeros();
                    for (increment, psi) in increments.iter().zip(&costate) {
                        mean += psi.fixed_rows::<1>(k) * (increment.variance[k] / total);
                    }
                    for psi in &mut costate {
                        let held = psi.fixed_rows::<1>(k) - mean;
                        psi.set_row(k, &held);
                    }
                }
            }
        }
        costate
    }

    /// Derivative of `⟨Ω, F⟩`, `Ω` symmetric.
    #[must_use]
    pub fn derivative(&self, at: &Linearised<D, P>, omega: &SMatrix<f64, P, P>) -> InformationDerivative<D> {
        let mut nodes = vec![SVector::zeros(); at.residual.len()];
        // reading r depends on acceleration k through its parameter S_rk
        let pull = |felt: &SMatrix<f64, D, P>| {
            SVector::<f64, D>::from_fn(|k, _| {
                (0..D).map(|r| 2.0 * self.weight[r] * felt[(r, r * (D + 1) + 1 + k)]).sum()
            })
        };
        for (i, m) in self.sums.iter().enumerate() {
            let felt = at.ends(i).map(|r| r * omega);
            let (p0, p1) = (pull(&felt[0]), pull(&felt[1]));
            nodes[i] += p0 * m.m00 + p1 * m.m01;
            nodes[i + 1] += p0 * m.m01 + p1 * m.m11;
            if let Some(clock) = &at.clock {
                let pulled = clock.pulled(i, &felt, [m.m00, m.m01, m.m11]).component_mul(&self.weight);
                let moved = self.s.tr_mul(&pulled) * (2.0 / self.interval_s(i));
                nodes[i] += moved;
                nodes[i + 1] -= moved;
            }
        }
        let mut variances = vec![SVector::zeros(); self.intervals()];
        for (variance, psi) in variances.iter_mut().zip(&at.costate) {
            let force = psi * omega;
            *variance = SVector::from_fn(|k, _| -force.row(k).dot(&psi.row(k)));
        }
        InformationDerivative { nodes, variances }
    }

    /// The same with respect to the nodes alone. The variances follow the jerk:
    /// `q = (floor + ratio |u|)² Δτ²`.
    #[must_use]
    pub fn total(
        &self,
        a: &[SVector<f64, D>],
        derivative: &InformationDerivative<D>,
    ) -> Vec<SVector<f64, D>> {
        let signs: Vec<_> = a.windows(2).map(|pair| (pair[1] - pair[0]).map(f64::signum)).collect();
        self.total_on_sides(a, derivative, &signs)
    }

    /// The same on the sides of the kinks at jerk zero that `signs` tell, one for each increment.
    #[must_use]
    pub fn total_on_sides(
        &self,
        a: &[SVector<f64, D>],
        derivative: &InformationDerivative<D>,
        signs: &[SVector<f64, D>],
    ) -> Vec<SVector<f64, D>> {
        let mut total = derivative.nodes.clone();
        if let Some((floor, ratio)) = self.input_noise() {
            for (i, variance) in derivative.variances.iter().enumerate() {
                let dt = self.interval_s(i);
                let step = SVector::<f64, D>::from_fn(|k, _| {
                    let size = ((a[i + 1][k] - a[i][k]) * signs[i][k]).max(0.0);
                    let kink = variance[k] * 2.0 * floor * dt * ratio;
                    (kink + variance[k] * 2.0 * ratio * ratio * size) * signs[i][k]
                });
                total[i] -= step;
                total[i + 1] += step;
            }
        }
        total
    }

    /// The prior on each increment.
    pub(super) fn increments(&self, a: &[SVector<f64, D>]) -> Vec<Increment<D>> {
        let rounding = 64.0 * f64::EPSILON * a.iter().map(SVector::amax).fold(0.0, f64::max);
        let mut increments: Vec<_> = (0..self.intervals())
            .map(|i| {
                let dt = self.interval_s(i);
                let variance = match self.trust {
                    Trust::Known => SVector::zeros(),
                    Trust::Unknown => SVector::repeat(f64::INFINITY),
                    Trust::Noisy(noise) => (a[i + 1] - a[i]).map(|step| {
                        let sd = noise.floor_mps3 * dt + noise.ratio * step.abs();
                        if sd <= rounding { 0.0 } else { sd * sd }
                    }),
                };
                Increment { variance, residual: SVector::zeros(), fixed: [false; D] }
            })
            .collect();
        if self.known_ends == KnownEnds::Both && self.trust != Trust::Known {
            // where the last increments are known exactly, the nodes before them are known, too
            for k in 0..D {
                for increment in increments.iter_mut().rev() {
                    increment.fixed[k] = true;
                    if increment.variance[k] != 0.0 {
                        break;
                    }
                }
            }
        }
        increments
    }
}
