//! Tests of every file that is read or written: good ones, broken ones, and there and back again.

mod broken;
mod conventions;
mod corrected;
mod earlier;
mod experiments;
mod good;
mod imu;
mod imu_calibration;
mod real;
mod recordings;
mod reference_log;
mod results;
#[cfg(feature = "study")]
mod study;
