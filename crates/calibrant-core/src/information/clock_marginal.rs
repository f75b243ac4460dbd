//! The clock of a recording in the information of its motion: delay and rate as nuisances, marginalised.
//!
//! Delay and rate ([`MotionClock`](crate::motion::MotionClock)) change the reading of an interval by `U = S j (1, s)`, with the jerk `j` and the time `s` from the middle of the motion. With
//! the information `F` of parameters and clock, the motion marginalised, and what is known of the clock `K = diag(sd)⁻²`, the parameters have
//!
//! `F_p = F_pp − B F_cp`, `B = F_pc (F_cc + K)⁻¹`
//!
//! This is the minimum over `B` of the information of the sensitivity `R − U Bᵀ`, with `B K Bᵀ` added. So its derivative may keep `B` constant, as it keeps the
//! motion's response (envelope theorem).

use super::chain_model as model;
use super::clock_response::{BORDER, ClockResponse, marginal};
use super::motion_information::{Linearised, PartInformation};
use crate::arrowhead::{Arrowhead, Link};
use crate::motion::Trust;
use nalgebra::{DMatrix, SMatrix, SVector};

impl<const D: usize, const P: usize> PartInformation<D, P> {
    /// The equations of parameters and clock with the motion eliminated: the information, and the factored chain where there is one.
    fn with_clock(&self, a: &[SVector<f64, D>]) -> Option<(DMatrix<f64>, Option<Arrowhead<D, BORDER>>)> {
        let nodes_s = self.nodes_s();
        let zero = SVector::zeros();
        let link = |i: usize| -> Link<D, BORDER> {
            let (m, nodes) = (&self.sums[i], [&a[i], &a[i + 1]]);
            let jerk = (nodes[1] - nodes[0]) / self.interval_s(i);
            let clock = model::clock_sensitivity(&self.s, &jerk, [nodes_s[i], nodes_s[i + 1]]);
            let m = [m.m00, m.m01, m.m11];
            model::with_clock(&self.link(i, a), &self.s, &self.weight, m, nodes, &clock, [&zero, &zero])
        };
        let pick = |f: &SMatrix<f64, BORDER, BORDER>| DMatrix::from_fn(P + 2, P + 2, |i, j| f[(i, j)]);
        if self.trust == Trust::Known {
            let information: SMatrix<f64, BORDER, BORDER> = (0..self.intervals()).map(|i| link(i).c).sum();
            return Some((pick(&information), None));
        }
        let increments = self.increments(a);
        let increment = |i: usize| increments[i].clone();
        let system =
            Arrowhead::eliminate(self.intervals(), link, increment, SMatrix::zeros(), SVector::zeros())
                .ok()?;
        Some((pick(&system.information), Some(system)))
    }

    /// The information of parameters and clock, with the clock last: delay, rate. What is known of the clock is not in it.
    pub(super) fn joint_with_clock(&self, a: &[SVector<f64, D>]) -> Option<DMatrix<f64>> {
        self.with_clock(a).map(|(information, _)| information)
    }

    /// The information at a motion, the clock marginalised.
    pub(super) fn linearise_with_clock(&self, a: &[SVector<f64, D>]) -> Option<Linearised<D, P>> {
        let (joint, system) = self.with_clock(a)?;
        let (information, regression) = marginal(&joint, &self.clock);
        let regression = SMatrix::<f64, P, 2>::from_fn(|i, k| regression[(i, k)]);
        let mut residual: Vec<SMatrix<f64, D, P>> = a.iter().map(model::sensitivity).collect();
        if let Some(system) = &system {
            for parameter in 0..P {
                let mut step = SVector::<f64, BORDER>::zeros();
                step[parameter] = 1.0;
                step.fixed_rows_mut::<2>(P).copy_from(&-regression.row(parameter).transpose());
                for (r, moved) in residual.iter_mut().zip(&system.chain_step(&step)) {
                    let column = r.column(parameter) + self.s * moved;
                    r.set_column(parameter, &column);
                }
            }
        }
        let moved = (0..self.intervals()).map(|i| self.s * (a[i + 1] - a[i]) / self.interval_s(i)).collect();
        let clock = Some(ClockResponse { regression, moved, nodes_s: self.nodes_s() });
        let information = SMatrix::from_fn(|i, j| information[(i, j)]);
        let mut at = Linearised { information, residual, costate: Vec::new(), clock };
        if let Trust::Noisy(_) = self.trust {
            at.costate = self.costate(&at, &self.increments(a));
        }
        Some(at)
    }

    /// The times of the nodes from the middle of the motion, s.
    fn nodes_s(&self) -> Vec<f64> {
        let middle = 0.5 * (self.tau[0] + self.tau[self.intervals()]);
        self.tau.iter().map(|time| time - middle).collect()
    }
}
