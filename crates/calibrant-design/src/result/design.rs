//! The result of a design: motions, predicted covariances, starts and certificate.

use crate::limit_use;
use calibrant_core::error::UndeterminedGroup;
use calibrant_core::form::{finite, rows};
use calibrant_core::information::Criterion;
use calibrant_core::json::{if_any, if_some};
use calibrant_core::motion::{JerkControlledMotion, Limits};
use calibrant_core::sensor::{Axis, Parameter};
use calibrant_core::{json_name, json_object};
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::Serialize;

/// A start that ends within this of the best (relatively; for criterion D in nats) has reached it.
///
/// Far below a percent: criterion A in SI units is nearly the variance of the biases alone. Motions whose
/// scale factors differ by a third differ by a thousandth in it.
pub const AT_BEST: f64 = 1e-5;

/// The best motion found, beside the initial one, and its distance from the bound.
#[derive(Debug, Clone)]
pub struct Design {
    /// How the search ended.
    pub status: DesignStatus,
    /// The criterion that was minimised.
    pub criterion: Criterion,
    /// Name, unit, nominal value and spread of each parameter.
    pub parameters: Vec<Parameter>,
    /// The best motion.
    pub optimal: Evaluation,
    /// The initial motion of the search: random, within a tenth of the limits, as in the thesis.
    pub initial: Evaluation,
    /// The motion that an engineer would write: the best shuttle at the limits. `None` where the intervals or the limits leave no room for one.
    pub shuttle: Option<Evaluation>,
    /// Every start, in order.
    pub starts: Vec<StartOutcome>,
    /// Iterations over all starts.
    pub iterations: usize,
    /// The limits that the motion keeps at all times, the sensor's range among them.
    pub limits: Limits,
    /// The lower bound, where it was wanted and found.
    pub certificate: Option<Certificate>,
    /// The gap that the search was to reach, where one was asked for.
    pub gap_goal: Option<GapGoal>,
    /// The part of the criterion that no motion changes: the share of gravity's tilt ([`DesignProblem::floor`](crate::DesignProblem::floor)).
    /// Gaps compare what is above it.
    pub floor: f64,
    /// Standard deviation that gravity's tilt alone gives each parameter, whatever the motion. Empty without gravity.
    pub floor_sd: Vec<f64>,
}

/// A gap to the lower bound at which a search ends.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct GapGoal {
    /// The gap: relative, for criterion D in nats.
    pub gap: f64,
    /// Number of starts after which the search would have ended in any case, over all axes.
    pub most_starts: usize,
}

impl Design {
    /// How much worse a value of the criterion is than `best`, above the part that no motion changes.
    #[must_use]
    pub fn gap(&self, value: f64, best: f64) -> f64 {
        self.criterion.gap(value - self.floor, best - self.floor)
    }

    /// The motion with which the best one is compared, and its name: the shuttle, or the random initial motion where there is no room for one.
    #[must_use]
    pub fn baseline(&self) -> (&'static str, &Evaluation) {
        self.shuttle.as_ref().map_or(("random", &self.initial), |shuttle| ("shuttle", shuttle))
    }

    /// How many times the information of that motion the best one has: the number of its recordings that tell as much as one of the best. `None` where
    /// either leaves parameters undetermined.
    #[must_use]
    pub fn information_over_baseline(&self) -> Option<f64> {
        let (before, best) = (self.baseline().1.value, self.optimal.value);
        let times = match self.criterion {
            Criterion::D(_) => ((before - best) / self.parameters.len() as f64).exp(),
            _ => (before - self.floor) / (best - self.floor),
        };
        times.is_finite().then_some(times)
    }

    /// Is the gap that was asked for proved? `None` where none was asked for.
    #[must_use]
    pub fn gap_is_reached(&self) -> Option<bool> {
        let goal = self.gap_goal?;
        Some(self.certificate.as_ref().is_some_and(|certificate| certificate.gap <= goal.gap))
    }

    /// Number of starts that converged.
    #[must_use]
    pub fn starts_converged(&self) -> usize {
        self.starts.iter().filter(|start| start.status == DesignStatus::Converged).count()
    }

    /// Number of starts that ended within [`AT_BEST`] of the best of their axes.
    #[must_use]
    pub fn starts_at_best(&self) -> usize {
        let best = |axes: &[Axis]| {
            let own = self.starts.iter().filter(|start| start.axes == axes);
            own.map(|start| start.value).fold(f64::INFINITY, f64::min)
        };
        let near =
            |start: &&StartOutcome| self.criterion.gap(start.value, best(&start.axes)).abs() <= AT_BEST;
        self.starts.iter().filter(near).count()
    }
}

json_object! {
    /// The best motion found, beside the initial one, and its distance from the bound.
    Design as of {
        /// How the search ended.
        status: of.status,
        criterion: &of.criterion,
        /// What the motion determines: the order of all lists of parameters.
        parameters: &of.parameters,
        optimal: &of.optimal,
        /// The initial motion of the search: random, within a tenth of the limits.
        initial: &of.initial,
        /// The best shuttle at the limits, with which the design is compared; `null` where there is no room for one.
        shuttle: &of.shuttle,
        /// What the best motion is compared with: `shuttle`, or `random` where there is none.
        baseline: of.baseline().0,
        /// How many times the information of that motion the best one has.
        information_over_baseline: of.information_over_baseline(),
        certificate: &of.certificate,
        /// The part of the criterion that no motion changes: that of gravity's tilt.
        floor: of.floor,
        /// Standard deviation that gravity's tilt alone gives each parameter.
        floor_sd: if_any(of.floor_sd.as_slice()),
        limits: &of.limits,
        /// How far the motion goes towards each limit.
        limit_use: limit_use(&of.limits, of.optimal.motion.axes(), &of.optimal.motion),
        gap_goal: if_some(of.gap_goal),
        /// Is the gap that was asked for reached?
        gap_is_reached: if_some(of.gap_is_reached()),
        /// Number of starts that converged.
        starts_converged: of.starts_converged(),
        /// Number of iterations of all starts.
        iterations: of.iterations,
        starts: &of.starts,
    }
}

/// The information that a recording of a motion will give.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// The motion.
    pub motion: JerkControlledMotion,
    /// Value of the criterion; infinite where the motion does not determine the parameters.
    pub value: f64,
    /// Information on the parameters, with the information that was there before.
    pub information: DMatrix<f64>,
    /// Predicted covariance; `None` where the motion does not determine the parameters.
    pub covariance: Option<DMatrix<f64>>,
    /// The parameters that it leaves undetermined, in words.
    pub undetermined: Vec<UndeterminedGroup>,
}

impl Evaluation {
    /// Predicted standard deviation of each parameter; infinite where it is not determined.
    #[must_use]
    pub fn sd(&self) -> Vec<f64> {
        match &self.covariance {
            Some(covariance) => covariance.diagonal().iter().map(|variance| variance.sqrt()).collect(),
            None => vec![f64::INFINITY; self.information.nrows()],
        }
    }
}

json_object! {
    /// The information that a recording of a motion will give.
    Evaluation as of {
        /// Value of the criterion; `null` where the motion does not determine the parameters.
        value: finite(of.value),
        /// Predicted standard deviation of each parameter.
        sd: of.sd().into_iter().map(finite).collect::<Vec<_>>(),
        /// Predicted covariance of the parameters.
        covariance: of.covariance.as_ref().map(rows),
        /// Parameters that it leaves undetermined.
        undetermined: if_any(of.undetermined.as_slice()),
        motion: &of.motion,
    }
}

/// How a design ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DesignStatus {
    /// The best start converged.
    Converged,
    /// The best start reached the iteration limit: its motion is admissible, a better one may be near.
    IterationLimit,
    /// The best start stopped because a subproblem could not be solved: its motion is admissible, a better one may be near.
    Stalled,
    /// The search was interrupted, or its time was over before the best start converged: its motion is the best so far, a better one may be near.
    Interrupted,
}

json_name!(DesignStatus);

impl DesignStatus {
    /// As written in files: `converged`, `iteration_limit`, `stalled`, `interrupted`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::IterationLimit => "iteration_limit",
            Self::Stalled => "stalled",
            Self::Interrupted => "interrupted",
        }
    }
}

/// One start of the search.
#[derive(Debug, Clone, PartialEq)]
pub struct StartOutcome {
    /// The axes that were designed: one, several that share the same problem, or all of a full sensor.
    pub axes: Vec<Axis>,
    /// Number of the start among those of these axes, from 0; 0 is the initial motion.
    pub number: usize,
    /// Value of the criterion, for the parameters of one of these axes, where it began. With gravity it is that of
    /// the covariance that the motion decides: without the part that no motion changes.
    pub initial_value: f64,
    /// Value where it ended.
    pub value: f64,
    /// Iterations.
    pub iterations: usize,
    /// How it ended.
    pub status: DesignStatus,
}

json_object! {
    /// One start of the search.
    StartOutcome as of {
        /// The axes that were designed together.
        axes: of.axes.iter().map(|axis| axis.letter()).collect::<Vec<_>>(),
        /// Among those of these axes; 0 is the initial motion.
        number: of.number,
        /// Value of the criterion where it began.
        initial_value: of.initial_value,
        /// Value of the criterion where it ended.
        value: of.value,
        /// Number of iterations.
        iterations: of.iterations,
        /// How it ended.
        status: of.status,
    }
}

/// A lower bound on the criterion that no admissible motion can beat.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Certificate {
    /// The bound.
    pub lower_bound: f64,
    /// How far the design is from the bound: `value/bound − 1`, for criterion D the difference in nats. Both are taken
    /// above the part that no motion changes.
    pub gap: f64,
    /// Smallest standard deviation that any admissible motion can give each parameter.
    pub sd_lower_bound: Vec<f64>,
    /// Which bound it is, and why it may be loose, in words.
    pub explanation: String,
}
