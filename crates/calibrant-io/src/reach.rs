//! The goals of `design --reach`, as `design.json` has them.

use calibrant_design::Goal;
use serde::Serialize;

/// The goals that a design reaches, and what is proved of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Reached {
    /// The goals.
    pub goals: Vec<Goal>,
    /// No design of fewer intervals, or poses, reaches them. `None` without a certificate.
    pub at_least: Option<usize>,
}

#[derive(Serialize)]
pub(super) struct ReachFields {
    goals: Vec<GoalFields>,
    at_least: Option<usize>,
}

#[derive(Serialize)]
struct GoalFields {
    name: String,
    sd: f64,
}

impl ReachFields {
    /// `names`: those of the parameters.
    pub(super) fn of(reached: &Reached, names: &[String]) -> Self {
        let fields = |goal: &Goal| GoalFields { name: names[goal.parameter].clone(), sd: goal.sd };
        Self { goals: reached.goals.iter().map(fields).collect(), at_least: reached.at_least }
    }
}
