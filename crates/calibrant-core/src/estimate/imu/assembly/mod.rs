//! Assembly of the result from its parts.

pub(crate) mod gyroscope_before;
pub(crate) mod holds;
pub(crate) mod imu_calibration;
pub(crate) mod rotations;
pub(crate) mod stationary;
