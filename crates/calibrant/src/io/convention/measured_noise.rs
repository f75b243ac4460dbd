//! Noise densities from `noise.json`, as `calibrant noise` writes it, for formats that carry one number for a sensor.

use super::{ImuNoise, LARGEST, complaint};
use crate::error::{Error, Result};
use crate::io::json;
use crate::io::text::{self, Checked};
use crate::sensor::{CalibratedImu, Triad};
use serde::Deserialize;
use std::path::Path;

const HELP: &str = "give noise.json as `calibrant noise` writes it";

#[derive(Deserialize)]
struct NoiseFile {
    sensors: Vec<Sensor>,
}

#[derive(Deserialize)]
struct Sensor {
    sensor: String,
    reading_unit: String,
    interval_s: f64,
    axes: Vec<Axis>,
    doubt: Option<String>,
}

#[derive(Deserialize)]
struct Axis {
    axis: String,
    random_walk: Coefficient,
    rate_random_walk: Coefficient,
}

#[derive(Deserialize)]
struct Coefficient {
    value: Option<f64>,
}

/// Reads the densities of `noise.json`: of the three axes the largest, in SI; the gain for readings in counts is that of the calibration.
///
/// A coefficient that is not determined on every axis is not given: Kalibr's users put a multiple of the datasheet's there.
///
/// # Errors
/// [`Error::Experiment`] with the file: not readable, no `noise.json`, noise that is not that of a sensor at rest, a number that is not positive, counts of a sensor whose calibration is of SI readings.
pub fn read_measured_noise(path: &Path, imu: &CalibratedImu) -> Result<ImuNoise> {
    let read = || -> Checked<ImuNoise> {
        let bytes = text::read_bytes(path, LARGEST, "noise.json")?;
        let file: NoiseFile = serde_json::from_str(text::as_text(&bytes)?)
            .map_err(|error| json::broken(&error, "the noise of a sensor", HELP))?;
        let mut noise = ImuNoise::default();
        for sensor in &file.sensors {
            take(&mut noise, sensor, imu)?;
        }
        noise.checked()
    };
    read().map_err(|complaint| Error::experiment(complaint.in_file(path)))
}

fn take(noise: &mut ImuNoise, sensor: &Sensor, imu: &CalibratedImu) -> Checked<()> {
    let Some(triad) = Triad::ALL.into_iter().find(|triad| triad.name() == sensor.sensor) else {
        return Err(complaint(format!("no sensor is called \"{}\"", sensor.sensor), HELP));
    };
    let Some(unit) = imu.unit(triad) else { return Ok(()) };
    if let Some(doubt) = &sensor.doubt {
        let message = format!("the noise of the {triad} is not that of a sensor at rest: {doubt}");
        return Err(complaint(message, "run `calibrant noise` on a recording at rest"));
    }
    let is_physical = sensor.reading_unit == triad.stimulus_unit().symbol();
    if !is_physical && unit.symbol() != sensor.reading_unit {
        let message = format!(
            "the noise of the {triad} is in {}, the calibration in {}",
            sensor.reading_unit,
            unit.symbol()
        );
        return Err(complaint(
            message,
            "run `calibrant noise` on the same readings, or give it their --gain",
        ));
    }
    let matrix = &imu.parameters.triad(triad).matrix;
    let gain = |name: &str| {
        let row = ["x", "y", "z"].iter().position(|axis| *axis == name)?;
        Some(if is_physical { 1.0 } else { matrix.row(row).norm() })
    };
    let largest = |of: fn(&Axis) -> &Coefficient| -> Option<f64> {
        let densities: Option<Vec<f64>> =
            sensor.axes.iter().map(|axis| Some(of(axis).value? / gain(&axis.axis)?)).collect();
        densities?.into_iter().reduce(f64::max)
    };
    let (density, walk) = (largest(|axis| &axis.random_walk), largest(|axis| &axis.rate_random_walk));
    match triad {
        Triad::Accelerometer => {
            (noise.accelerometer_density, noise.accelerometer_random_walk) = (density, walk)
        }
        Triad::Gyroscope => (noise.gyroscope_density, noise.gyroscope_random_walk) = (density, walk),
    }
    noise.update_rate_hz = Some(1.0 / sensor.interval_s);
    Ok(())
}
