//! The data type of a recording after its correction: corrected values, with their standard uncertainty.

use super::MissingSpecificForce;
use nalgebra::Vector3;

/// A corrected recording of an IMU.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CorrectedRecording<'a> {
    /// Specific force, m/s².
    pub accelerometer: Option<CorrectedSensor<'a>>,
    /// Angular rate, rad/s.
    pub gyroscope: Option<CorrectedSensor<'a>>,
    /// Where the correction of the g-sensitivity lacks a specific force. `None` where the accelerometer has
    /// data at every sample of the gyroscope, or where the correction does not need them.
    pub missing_specific_force: Option<MissingSpecificForce>,
}

/// Corrected readings of one sensor over time.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrectedSensor<'a> {
    /// Sample times, s: those of the recording.
    pub times_s: &'a [f64],
    /// Corrected readings, in the sensor's SI unit.
    pub values: Vec<Vector3<f64>>,
    /// Standard uncertainty of the correction at each sample; `None` where the calibration has no covariance
    /// of this sensor.
    pub sd: Option<Vec<Vector3<f64>>>,
}
