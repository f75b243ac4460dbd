//! Alignment of the two sensors: the gyroscope's gain, and how its axes lie in the accelerometer's frame.

pub(crate) mod axes;
pub(crate) mod coarse_rotations;
pub(crate) mod mounting;
pub(crate) mod search;
pub(crate) mod stage;
