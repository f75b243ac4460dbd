//! The nominal gains of the sensors of an IMU.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::ReadingUnit;
use calibrant_io::Experiment;
use nalgebra::Vector3;

/// Nominal gains of accelerometer and gyroscope, in the unit of the readings: 1 where they are in SI, or where there is no gyroscope.
pub(super) fn gains(experiment: &Experiment) -> Result<[Vector3<f64>; 2]> {
    let needs = |key: &str| {
        let input_error = InputError::new(
            Refusal::KeyMissing,
            format!("a simulation of counts needs `{key}`"),
            "add it to the experiment file",
        );
        Error::experiment(input_error.about_key(key))
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
