//! One start of the search: sequential convex programming from a motion to a local optimum.
//!
//! Each iteration minimises a convex model of the criterion over the admissible motions, and goes to the
//! minimum, or as far towards it as the criterion falls. All limits are convex, so every iterate is
//! admissible.
//!
//! - Short motions with a smooth criterion have the positive part of the exact second derivative for a model
//!   ([`crate::local_search::criterion_hessian`]). Their program is dense, and keeps its active rows from one iteration to
//!   the next ([`crate::local_search::short_program`]).
//! - Long motions have a model without the curvature of the information ([`crate::local_search::long_program`]), and so have the
//!   criteria that are not smooth, E ([`crate::local_search::eigenvalue_program`]) and M ([`crate::local_search::epigraph_program`]).
//!
//! A model without that curvature underrates what lies further on the same way, and a start of 1000 intervals crept.
//! So after a full step, the model of a long motion is taken around the point that another such step would reach. The
//! linearised information is a lower bound wherever it is taken. Where the criterion does not fall for it, the model
//! around the motion itself decides, also on whether the start has converged (`phan2018`).
//!
//! # References
//! `phan2018`

use super::{EigenvalueProgram, EpigraphProgram, LongProgram, Nodes, Part, ShortProgram, mix};
use crate::{DesignSettings, DesignStatus};
use calibrant_core::information::Criterion;
use calibrant_core::motion::Trust;
use nalgebra::SVector;

/// The result of one start of the search.
#[derive(Debug, Clone)]
pub(crate) struct LocalOptimum<const D: usize> {
    pub(crate) nodes: Nodes<D>,
    pub(crate) value: f64,
    pub(crate) initial_value: f64,
    pub(crate) iterations: usize,
    pub(crate) status: DesignStatus,
}

/// The model's decrease, relative to the most that the gradient could promise, below which a start has converged.
const CONVERGED: f64 = 1e-9;
/// The same threshold where rounding keeps the criterion from falling further.
const EXHAUSTED: f64 = 1e-5;
/// The way from the last motion, as a multiple of that to the present one, to the point around which the next model is taken.
const AHEAD: f64 = 2.0;
/// Largest number of unknowns of a short motion. A dense program takes time with the cube of it.
pub(crate) const SHORT: usize = 160;

/// The model of one start.
enum Model<const D: usize> {
    Short(Box<ShortProgram<D>>),
    Long(LongProgram<D>),
    Eigenvalue(EigenvalueProgram<D>),
    Epigraph(EpigraphProgram<D>),
}

impl<const D: usize> Model<D> {
    /// The step from `a` with the model around a point.
    fn step<const P: usize>(
        &mut self,
        part: &Part<D, P>,
        around: &[SVector<f64, D>],
        a: &[SVector<f64, D>],
    ) -> Option<(Nodes<D>, f64)> {
        match self {
            Self::Short(program) => program.step(part, a),
            Self::Long(program) => program.step(part, around, a),
            Self::Eigenvalue(program) => program.step(part, a),
            Self::Epigraph(program) => program.step(part, a),
        }
    }

    /// Is it taken around a point further on the way than the motion?
    fn looks_ahead(&self) -> bool {
        matches!(self, Self::Long(_))
    }

    fn moved(&mut self, fraction: f64) {
        match self {
            Self::Short(program) => program.moved(fraction),
            Self::Long(program) => program.bend.moved(fraction),
            Self::Eigenvalue(_) => (),
            Self::Epigraph(program) => program.bend.moved(fraction),
        }
    }

    fn blocked(&mut self) -> bool {
        match self {
            Self::Short(program) => program.blocked(),
            Self::Long(program) => program.bend.blocked(),
            // its bound is minimised as it is
            Self::Eigenvalue(_) => false,
            Self::Epigraph(program) => program.bend.blocked(),
        }
    }
}

impl<const D: usize, const P: usize> Part<D, P> {
    /// Value of the criterion; infinite where the motion does not determine the parameters.
    pub(crate) fn value(&self, a: &[SVector<f64, D>]) -> f64 {
        self.information
            .linearise(a)
            .and_then(|at| self.covariance(&at))
            .map(|c| self.criterion_at(&c))
            .filter(|value| value.is_finite())
            .unwrap_or(f64::INFINITY)
    }

    /// Improves an admissible motion.
    pub(crate) fn improve(&self, start: Nodes<D>, settings: &DesignSettings) -> LocalOptimum<D> {
        let mut a = start;
        let mut value = self.value(&a);
        let initial_value = value;
        let end = |nodes, value, iterations, status| LocalOptimum {
            nodes,
            value,
            initial_value,
            iterations,
            status,
        };
        let short = a.len() * D <= SHORT && self.information.trust() != Trust::Unknown;
        let mut model = match &self.criterion {
            Criterion::E(_) => Model::Eigenvalue(EigenvalueProgram::new()),
            Criterion::M(_) => Model::Epigraph(EpigraphProgram::new(P)),
            _ if short => Model::Short(Box::new(ShortProgram::new(&self.regions))),
            _ => Model::Long(LongProgram::new()),
        };
        // the motion before, where it leads further
        let mut last: Option<Nodes<D>> = None;
        for iteration in 0..settings.max_iterations {
            if settings.interruption.is_asked() {
                return end(a, value, iteration, DesignStatus::Interrupted);
            }
            let ahead = last.take().map(|last| mix(&last, &a, AHEAD));
            let step = model.step(self, ahead.as_ref().unwrap_or(&a), &a);
            let solved = step.is_some();
            let promise = step.as_ref().map_or(0.0, |(_, promise)| *promise);
            let moved = step
                .filter(|_| promise > CONVERGED)
                .and_then(|(target, _)| self.descend(&a, &self.restored(target), value));
            if let Some((next, next_value, fraction)) = moved {
                model.moved(fraction);
                value = next_value;
                let before = std::mem::replace(&mut a, next);
                last = (fraction == 1.0 && model.looks_ahead()).then_some(before);
                continue;
            }
            if ahead.is_some() {
                // the model around the motion itself decides
                continue;
            }
            if !solved {
                return end(a, value, iteration, DesignStatus::Stalled);
            }
            if promise <= CONVERGED {
                return end(a, value, iteration, DesignStatus::Converged);
            }
            if !model.blocked() {
                let status =
                    if promise <= EXHAUSTED { DesignStatus::Converged } else { DesignStatus::Stalled };
                return end(a, value, iteration, status);
            }
        }
        end(a, value, settings.max_iterations, DesignStatus::IterationLimit)
    }

    /// The furthest of the points `a + 2⁻ᵏ (target − a)` at which the criterion is lower.
    fn descend(
        &self,
        a: &[SVector<f64, D>],
        target: &[SVector<f64, D>],
        value: f64,
    ) -> Option<(Nodes<D>, f64, f64)> {
        let mut fraction = 1.0;
        for _ in 0..30 {
            let next: Nodes<D> = a.iter().zip(target).map(|(a, b)| a + (b - a) * fraction).collect();
            let next_value = self.value(&next);
            if next_value < value {
                return Some((next, next_value, fraction));
            }
            fraction /= 2.0;
        }
        None
    }

    /// The motion with every axis restored into its region.
    pub(crate) fn restored(&self, mut nodes: Nodes<D>) -> Nodes<D> {
        for k in 0..D {
            let mut own: Vec<f64> = nodes.iter().map(|node| node[k]).collect();
            let inside: Vec<f64> = self.inside.iter().map(|node| node[k]).collect();
            self.regions[k].restore(&mut own, &inside, self.slack);
            nodes.iter_mut().zip(own).for_each(|(node, own)| node[k] = own);
        }
        nodes
    }
}

#[cfg(test)]
#[path = "long_motion_tests.rs"]
mod tests;
