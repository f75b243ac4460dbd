//! The nominal gains of the sensors of an IMU.

use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::Experiment;
use calibrant::sensor::ReadingUnit;
use nalgebra::Vector3;
use std::path::Path;

/// Nominal gains of accelerometer and gyroscope, in the unit of the readings: 1 where they are in SI, or where there is no gyroscope.
pub(super) fn gains(experiment: &Experiment, file: &Path) -> calibrant::Result<[Vector3<f64>; 2]> {
    let needs = |key: &str| {
        let input_error = InputError::new(
            Refusal::KeyMissing,
            format!("a simulation of counts needs `{key}`"),
            "add it to the experiment file",
        );
        Error::Experiment(Box::new(input_error.in_file(file).about_key(key)))
    };
    let accelerometer = experiment.sensor.gain.ok_or_else(|| needs("sensor.gain_counts_per_mps2"))?;
    let gyroscope = match experiment.imu.as_ref().map(|imu| &imu.gyroscope) {
        Some(of) if of.unit == ReadingUnit::Counts => {
            of.gain.ok_or_else(|| needs("gyroscope.gain_counts_per_radps"))?
        }
        _ => Vector3::repeat(1.0),
    };
    Ok([accelerometer, gyroscope])
}
