//! The motion of the sensor: jerk-controlled motion, how far it is trusted, static holds, gravity, Earth's
//! rate and the arm's limits.

mod commanded_motion;
mod gravity;
mod hold;
mod jerk_controlled;
mod limits;
mod motion_clock;
mod sample_times;
mod turn_axis;

pub use commanded_motion::{CommandedMotion, InputNoise, KnownEnds, Trust};
pub use gravity::{EARTH_RATE_RADPS, Gravity, MotionGravity, earth_rate};
pub use hold::Hold;
pub(crate) use hold::to_ms;
pub use jerk_controlled::{JerkControlledMotion, MotionState, MotionTable};
pub use limits::{AxisLimits, Limits, Rest};
pub use motion_clock::MotionClock;
pub use sample_times::{IntervalSums, sample_count, sample_times};
pub(crate) use turn_axis::turn_axis_sd_rad;
