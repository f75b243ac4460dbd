//! The motion of the sensor: jerk-controlled motion, how far it is trusted, static holds, gravity, Earth's
//! rate and the arm's limits.

mod commanded_motion;
mod earth_rate;
mod gravity;
mod hold;
mod jerk_controlled;
mod limits;
mod motion_gravity;
mod motion_state;
mod sample_times;
mod table;

pub use commanded_motion::{CommandedMotion, InputNoise, KnownEnds, Trust};
pub use earth_rate::{EARTH_RATE_RADPS, earth_rate};
pub use gravity::Gravity;
pub use hold::Hold;
pub(crate) use hold::to_ms;
pub use jerk_controlled::JerkControlledMotion;
pub use limits::{AxisLimits, Limits, Rest};
pub use motion_gravity::MotionGravity;
pub use motion_state::MotionState;
pub use sample_times::{IntervalSums, sample_times};
pub use table::MotionTable;
