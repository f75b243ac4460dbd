//! The data type of the plan: how the sensor is moved.

use super::holds::HoldsPlan;
use super::machine::MachinePlan;
use super::motion::MotionPlan;

/// How the sensor is moved.
#[derive(Debug, Clone, PartialEq)]
pub enum Plan {
    /// `[motion]`: along a commanded motion.
    Motion(MotionPlan),
    /// `[holds]`: held still in several orientations.
    Holds(HoldsPlan),
    /// `[machine]`: by a machine whose motion is logged.
    Machine(Box<MachinePlan>),
}

impl Plan {
    /// The section that describes it.
    #[must_use]
    pub fn section(&self) -> &'static str {
        match self {
            Self::Motion(_) => "[motion]",
            Self::Holds(_) => "[holds]",
            Self::Machine(_) => "[machine]",
        }
    }
}
