//! Where the sensor is: jerk-controlled motion, how far it is trusted, static holds, gravity and the arm's limits.

mod at_time;
mod command;
mod earth;
mod gravity;
mod hold;
mod jerk_controlled;
mod limits;
mod sampling;

pub use at_time::MotionState;
pub use command::{CommandedMotion, InputNoise, KnownEnds, Trust};
pub use earth::{EARTH_RATE_RADPS, earth_rate};
pub use gravity::Gravity;
pub use hold::Hold;
pub(crate) use hold::to_ms;
pub use jerk_controlled::JerkControlledMotion;
pub use limits::{AxisLimits, Limits, Rest};
pub use sampling::{IntervalSums, sample_times};
