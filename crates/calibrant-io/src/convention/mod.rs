//! Calibrations of an IMU in the formats of other programs, and in our own: one file for each format.
//!
//! | format | file | direction | true frame | units of readings | cannot carry |
//! |---|---|---|---|---|---|
//! | [`CalibrantJson`](ImuFormat::CalibrantJson) | `.json` | true → raw | any, said in words and by its gauge | m/s², rad/s, counts | |
//! | [`Kalibr`](ImuFormat::Kalibr) | `imu.yaml` | true → raw | `M` lower triangular; another frame through `T_i_b` | m/s², rad/s | covariance; temperature; biases and counts only in keys that Kalibr does not read |
//! | [`ImuTk`](ImuFormat::ImuTk) | `.calib`, one for each sensor | raw → true | any; its own results have the upper gauge | not said | covariance, g-sensitivity, temperature |
//! | [`Imucal`](ImuFormat::Imucal) | `.json` with `cal_type` | true → raw | any | named; true rates in deg/s | covariance; temperature; one sensor alone |
//! | [`CHeader`](ImuFormat::CHeader) | `.h` | raw → true | any, said in words | named | covariance |
//!
//! When a format cannot carry something, the writer warns. It refuses where the correction itself would
//! change. A finding states what a reader had to assume. What is ambiguous (the unit of imu_tk's readings)
//! the user must give.

mod arrays;
mod c_constants;
mod c_header;
mod c_nonlinearity;
mod c_temperature;
mod calibrant_json;
mod degrees_of_freedom;
mod file;
mod format;
mod imu_noise;
mod imu_tk;
mod imucal;
mod json_core;
mod kalibr;
mod kalibr_keys;
mod measured_noise;
mod options;
mod read;
mod temperature;
mod truth;
mod usable_calibration;
mod words;
mod write;

pub(crate) use calibrant_json::read_estimates;
pub use calibrant_json::{ConvertedFile, parse_estimates};
pub use file::{CalibratedImuFile, WrittenImu};
pub use format::ImuFormat;
pub use imu_noise::ImuNoise;
pub use imu_tk::imu_tk_files;
pub use json_core::ImuCore;
pub use kalibr::read_kalibr_noise;
pub use measured_noise::read_measured_noise;
pub use options::{ConventionOptions, RawUnits};
pub use read::{parse_calibrated_imu, read_calibrated_imu};
pub use write::{calibrated_imu_texts, write_calibrated_imu};
