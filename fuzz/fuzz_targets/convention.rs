//! The check of the fuzz targets for formats of calibrations. A calibration is refused with an error, or its
//! correction is finite and it can be written again.

use calibrant::io::{
    CalibratedImuFile, ConventionOptions, ImuFormat, RawUnits, calibrated_imu_texts, parse_calibrated_imu,
};
use calibrant::sensor::{ImuCorrection, SensorKind};
use nalgebra::Vector3;

/// The bytes as a calibration of this format.
pub fn check(bytes: &[u8], format: ImuFormat) {
    let options =
        ConventionOptions { format: Some(format), units: Some(RawUnits::Counts), sensor_kind: Some(SensorKind::Accelerometer) };
    match parse_calibrated_imu(bytes, &options) {
        Ok(file) => is_usable(&file, format),
        Err(error) => assert!(error.is_invalid_experiment() && !error.to_string().is_empty()),
    }
    // the content decides the format
    if let Err(error) = parse_calibrated_imu(bytes, &ConventionOptions::default()) {
        assert!(error.is_invalid_experiment() && !error.to_string().is_empty());
    }
}

fn is_usable(file: &CalibratedImuFile, format: ImuFormat) {
    let correction = ImuCorrection::of(&file.imu).expect("what is read can be applied");
    let zero = Vector3::zeros();
    let force = correction.force(&zero).unwrap_or(zero);
    assert!(force.iter().all(|value| value.is_finite()));
    if let Some(sd) = correction.force_sd(&force) {
        assert!(sd.iter().all(|sd| *sd >= 0.0));
    }
    // texts may hold any word, numbers may not
    let mut file = file.clone();
    file.imu.frame.clear();
    file.inputs.clear();
    match calibrated_imu_texts(&file, format) {
        Ok(texts) => assert!(texts.iter().all(|(_, text)| !text.contains("NaN") && !text.contains("inf,"))),
        // what Kalibr's model cannot express, it cannot write either
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
