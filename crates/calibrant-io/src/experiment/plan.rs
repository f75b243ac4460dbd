//! The data type of the plan: how the sensor is moved.

use super::holds::HoldsPlan;
use super::motion::MotionPlan;

/// How the sensor is moved.
#[derive(Debug, Clone, PartialEq)]
pub enum Plan {
    /// `[motion]`: along a commanded motion.
    Motion(MotionPlan),
    /// `[holds]`: held still in several orientations.
    Holds(HoldsPlan),
}
