//! A calibrated IMU as it stands in a file.

use super::format::ImuFormat;
use super::imu_noise::ImuNoise;
use crate::calibration::Input;
use calibrant_core::sensor::CalibratedImu;
use std::path::PathBuf;

/// Largest file of a calibration, bytes.
pub(super) const LARGEST: u64 = 64 << 20;

/// A calibrated IMU as it stands in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedImuFile {
    /// The calibration.
    pub imu: CalibratedImu,
    /// Noise densities, where the file has them.
    pub noise: Option<ImuNoise>,
    /// The recordings that it came from, where the file says so.
    pub inputs: Vec<Input>,
    /// The format that it was read from.
    pub format: ImuFormat,
    /// What the reader supposed or left out.
    pub findings: Vec<String>,
}

/// What was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenImu {
    /// The files.
    pub files: Vec<PathBuf>,
    /// What the format cannot carry.
    pub warnings: Vec<String>,
}
