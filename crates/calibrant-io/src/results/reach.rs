//! The goals of `design --reach`, as `design.json` has them.

use calibrant_design::Goal;
use schemars::JsonSchema;
use serde::Serialize;

/// The goals that a design reaches, and what is proved of them.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Reached {
    /// The goals.
    pub goals: Vec<ReachedGoal>,
    /// No design of fewer intervals, or poses, reaches them. `None` without a certificate.
    pub at_least: Option<usize>,
}

/// The largest standard deviation of a parameter that is good enough.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ReachedGoal {
    /// The parameter.
    pub name: String,
    /// Its largest standard deviation, in its unit.
    pub sd: f64,
}

impl Reached {
    /// These goals for parameters of these names.
    #[must_use]
    pub fn new(goals: &[Goal], names: &[String], at_least: Option<usize>) -> Self {
        let named = |goal: &Goal| ReachedGoal { name: names[goal.parameter].clone(), sd: goal.sd };
        Self { goals: goals.iter().map(named).collect(), at_least }
    }
}
