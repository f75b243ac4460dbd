//! A whole IMU from one recording: held still in several orientations and turned in between, or turned by known angles.
//!
//! Holds give the accelerometer, as in a static calibration, and the gyroscope's bias. The rotations between them give the gyroscope's matrix: gravity
//! before a rotation, propagated through it by the gyroscope, is gravity after it. All of it is one least-squares problem with one covariance
//! (`least_squares`), in which the unknown directions of the holds form a chain whose links are the rotations. `solver` lists the stages.
//!
//! The weights come from the data: noise within holds, scatter between them, and the excess of the rotations' errors over their noise
//! (`variance_components`). Rotations that do not fit are left out and listed.
//!
//! The true frame is that of the accelerometer in its gauge; the gyroscope's matrix is given in it, so its misalignment to the accelerometer is in there. With
//! known directions (`ImuSetup::directions`) it is the frame of these directions.
//!
//! Bias and gain of both sensors may follow temperature, where the recording has one ([`ThermalModel`]).
//!
//! # References
//! `tedaldi2014`, `ferraris1995`

mod alignment;
mod assembly;
mod calibrate;
mod checks;
mod clock;
mod covariance;
mod earth_rate;
mod estimated;
mod initial;
mod least_squares;
mod model;
mod problem;
mod propagated_gravity;
mod recordings;
mod result;
mod rotations;
mod solver;
mod stationary;
mod temperature;
mod variance_components;
mod white_noise_search;

pub use calibrate::{calibrate_imu, calibrate_imu_with};
pub use checks::swapped_sensors::swapped_sensors;
pub use clock::rate::ClockRate;
pub use problem::{Gyroscope, ImuProblem, ImuSetup, KnownTerm, NoiseSource, ThermalModel, Turn, WhiteNoise};
pub(super) use propagated_gravity::{GravityPropagation, GyroscopeAtRest, PropagatedGravity, StationaryMean};
pub(super) use recordings::recordings;
pub use result::{GyroscopeCalibration, GyroscopeInHolds, RotationResult, TurnResult};
pub use stationary::intervals::{find_clean_imu_holds, find_imu_holds};
pub(super) use temperature::needed_temperatures;
pub use white_noise_search::WhiteNoiseSearch;
