//! Calibration of a whole IMU from one recording: holds in several orientations, with rotations in between or turns of known angle.
//!
//! Holds give the accelerometer, as in a static calibration, and the gyroscope's bias. The rotations between them give the gyroscope's matrix: gravity
//! before a rotation, propagated through it by the gyroscope, is gravity after it. All of this is one least-squares problem with one covariance
//! (`least_squares`). The unknown directions of the holds form a chain, and the rotations are its links. `solver` lists the stages.
//!
//! The weights come from the data: noise within holds, scatter between them, and the excess of the rotation errors over their noise
//! (`variance_components`). Rotations that contradict the others are not used, and listed.
//!
//! The true frame is that of the accelerometer in its gauge. The gyroscope's matrix is in the same frame, and includes its misalignment to the
//! accelerometer. With known directions (`ImuSetup::directions`) the true frame is that of these directions.
//!
//! Bias and gain of both sensors may follow temperature, if the recording has it ([`ThermalModel`]).
//!
//! # References
//! `tedaldi2014`, `ferraris1995`

mod alignment;
mod assembly;
mod calibrate;
mod checks;
mod clock;
mod clock_rate;
mod covariance;
mod drift_errors;
mod earth_rate;
mod estimated;
mod faces_alone;
mod faces_found;
mod initial;
mod knocks_kept;
mod known_term;
mod least_squares;
mod model;
mod problem;
mod propagated_gravity;
mod recording_biases;
mod recordings;
mod result;
mod rotations;
mod shared_face_errors;
mod solver;
mod stationary;
mod temperature;
mod temperature_rate;
mod terms;
mod thermometer;
mod thermometer_lag;
mod variance_components;
mod white_noise_search;

pub use calibrate::{calibrate_imu, calibrate_imu_with};
pub use checks::swapped_sensors::swapped_sensors;
pub use clock_rate::{ClockRate, TimeOffset};
pub use faces_alone::calibrate_faces;
pub use faces_found::{FacesFound, ON_FACE_RAD, faces_found};
pub use known_term::KnownTerm;
pub(super) use model::{HoldData, ImuModel, KNOCK_DEGREES, Prior, State};
pub use problem::{Gyroscope, ImuProblem, ImuSetup, NoiseSource, ThermalModel, Turn, WhiteNoise};
pub(super) use propagated_gravity::{GravityPropagation, GyroscopeAtRest, PropagatedGravity, StationaryMean};
pub(super) use recordings::recordings;
pub use result::{GyroscopeCalibration, GyroscopeInHolds, RotationResult, TurnResult};
pub(super) use rotations::gravity_at_ends::TurnsInHolds;
pub use stationary::intervals::{find_clean_imu_holds, find_imu_holds};
pub(super) use temperature::{at_sensor, needed_temperatures};
pub(super) use temperature_rate::temperature_rates;
pub use thermometer::ThermometerLag;
pub use white_noise_search::WhiteNoiseSearch;
