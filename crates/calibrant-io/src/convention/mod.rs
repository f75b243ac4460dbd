//! Calibrations of an IMU in the formats of other programs, and in our own: one file for each format.
//!
//! | format | file | direction | true frame | units of readings | cannot carry |
//! |---|---|---|---|---|---|
//! | [`CalibrantJson`](ImuFormat::CalibrantJson) | `.json` | true → raw | any, said in words and by its gauge | m/s², rad/s, counts | |
//! | [`Kalibr`](ImuFormat::Kalibr) | `imu.yaml` | true → raw | `M` lower triangular; another frame through `T_i_b` | m/s², rad/s | covariance; temperature; biases and counts only in keys that Kalibr does not read |
//! | [`ImuTk`](ImuFormat::ImuTk) | `.calib`, one for each sensor | raw → true | any; its own results have the upper gauge | not said | covariance, g-sensitivity, temperature |
//! | [`Imucal`](ImuFormat::Imucal) | `.json` with `cal_type` | true → raw | any | named; true rates in deg/s | covariance; temperature; one sensor alone |
//! | [`CHeader`](ImuFormat::CHeader) | `.h` | raw → true | any, said in words | named | covariance |
//! | [`OpenVins`](ImuFormat::OpenVins) | `.yaml` | true → raw | `Ta` lower triangular | m/s², rad/s | covariance, temperature; biases only in keys that OpenVINS does not read |
//! | [`Basalt`](ImuFormat::Basalt) | `.json`, written | raw → true | accelerometer's `A` lower triangular | m/s², rad/s | covariance, temperature, g-sensitivity |
//! | [`Px4`](ImuFormat::Px4) | `.params`, written | raw → true | the sensor's | m/s², rad/s | covariance, g-sensitivity, cross-axis sensitivity, the gyroscope's matrix, temperature of gains |
//! | [`ArduPilot`](ImuFormat::ArduPilot) | `.param`, written | raw → true | the sensor's | m/s², rad/s | as PX4's |
//! | [`ImuFusion`](ImuFormat::ImuFusion) | `.py`, written | raw → true | any, said in words | any, said | covariance, temperature, g-sensitivity |
//! | [`LibRealSense`](ImuFormat::LibRealSense) | `.json`, written | raw → true | any | m/s², rad/s | covariance, temperature, g-sensitivity |
//! | [`ImuCalib`](ImuFormat::ImuCalib) | `.yaml`, written | raw → true | any | m/s² | covariance, temperature, the gyroscope |
//!
//! When a format cannot carry something, the writer warns. It refuses where the correction itself would
//! change. A finding states what a reader had to assume. What is ambiguous (the unit of imu_tk's readings)
//! the user must give.

mod ardupilot;
mod arrays;
mod autopilot;
mod basalt;
mod c_constants;
mod c_header;
mod c_nonlinearity;
mod c_temperature;
mod calibrant_json;
mod degrees_of_freedom;
mod file;
mod format;
mod imu_calib;
mod imu_noise;
mod imu_tk;
mod imucal;
mod imufusion;
mod json_core;
mod kalibr;
mod kalibr_keys;
mod librealsense;
mod measured_noise;
mod openvins;
mod options;
mod prepared;
mod px4;
mod read;
mod soak;
mod table;
mod temperature;
mod truth;
mod usable_calibration;
mod words;
mod write;
mod yaml;

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
pub use soak::{ReadSoak, parse_soak};
pub use table::{TableError, write_temperature_table};
pub use write::{calibrated_imu_texts, edit_calibrated_imu, write_calibrated_imu};
