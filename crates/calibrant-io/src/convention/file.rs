//! The data types of a calibrated IMU as a file holds it.

use super::format::ImuFormat;
use super::imu_noise::ImuNoise;
use crate::results::input::Input;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::sensor::CalibratedImu;
use std::path::PathBuf;

/// Largest file of a calibration, bytes.
pub(super) const LARGEST: u64 = 64 << 20;

/// A calibrated IMU as a file holds it.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedImuFile {
    /// The calibration.
    pub imu: CalibratedImu,
    /// Noise densities, where the file has them.
    pub noise: Option<ImuNoise>,
    /// The recordings from which it came, where the file names them.
    pub inputs: Vec<Input>,
    /// The station where they were made, where the file names it.
    pub station: Option<String>,
    /// The format of the file.
    pub format: ImuFormat,
    /// What the reader assumed or ignored.
    pub findings: Vec<Diagnostic>,
}

impl CalibratedImuFile {
    /// This calibration in this format, with nothing beside it.
    #[must_use]
    pub fn new(imu: CalibratedImu, format: ImuFormat) -> Self {
        Self { imu, noise: None, inputs: Vec::new(), station: None, format, findings: Vec::new() }
    }
}

/// The result of writing a calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenImu {
    /// The files.
    pub files: Vec<PathBuf>,
    /// What the format cannot carry.
    pub warnings: Vec<Diagnostic>,
    /// The true frame of what is written, in words.
    pub frame: String,
}
