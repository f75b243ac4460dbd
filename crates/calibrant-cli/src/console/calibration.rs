//! A calibration on stdout, whatever the sensor.

use super::accelerometer::accelerometer_calibration;
use super::imu::imu_calibration;
use super::validation::validations;
use calibrant::pipeline::{Outcome, SensorCalibration};

/// What was used, the parameters, how good they are, and how they fare on other data.
pub(crate) fn calibration(outcome: &Outcome) -> String {
    let text = match &outcome.calibration {
        SensorCalibration::Accelerometer(calibration) => accelerometer_calibration(calibration),
        SensorCalibration::Imu(calibration) => imu_calibration(calibration),
    };
    text + &validations(&outcome.validations)
}
