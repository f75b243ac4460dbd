//! The noise of a sensor at rest.

use crate::failure::{invalid, raised};
use crate::options::{Reading, parsed};
use crate::page::{Page, page};
use crate::recording::{Recording, sensor_kind};
use crate::source::Source;
use crate::work::{How, run_as};
use calibrant::diagnostic::noise::NoiseImpossible;
use calibrant::diagnostic::{Diagnostic, Phrase};
use calibrant::io::{NoiseFile, to_json};
use calibrant::noise::SensorNoise;
use calibrant::report::{About, noise_sheet};
use calibrant::sensor::SensorKind;
use calibrant::{NoiseAtRest, NoiseOptions, Result, read_for_noise};
use nalgebra::Vector3;
use pyo3::prelude::*;
use std::sync::Arc;

/// Gain of each axis, or one of all.
type Gain = Vec<f64>;

/// Examines a recording at rest.
#[pyfunction]
#[pyo3(signature = (source, reading, *, read=None, sensor=None, hold_s=None, gain=None, gyroscope_gain=None, threads=None))]
#[expect(clippy::too_many_arguments, reason = "each is an argument of the Python function")]
pub(crate) fn noise(
    py: Python<'_>,
    source: &Source,
    reading: &str,
    read: Option<&Recording>,
    sensor: Option<&str>,
    hold_s: Option<(f64, f64)>,
    gain: Option<Gain>,
    gyroscope_gain: Option<Gain>,
    threads: Option<usize>,
) -> PyResult<Page> {
    let sensor = sensor.map(sensor_kind);
    let given = || -> Result<_> {
        let of_first = gains("gain", sensor.unwrap_or(SensorKind::Accelerometer), gain)?;
        let gains =
            of_first.into_iter().chain(gains("gyroscope_gain", SensorKind::Gyroscope, gyroscope_gain)?);
        let options = NoiseOptions { sensor, hold_s, gains: gains.collect(), ..NoiseOptions::default() };
        Ok((parsed::<Reading>(reading)?.options()?, options))
    };
    let (reading, options) = given().map_err(|error| raised(py, &error))?;
    let source = source.0.clone();
    // what is in memory would be read again with the same options
    let read = read.filter(|_| !source.recording.is_file() && options.gains.is_empty()).map(Recording::file);
    let how = How { threads, ..How::default() };
    run_as(py, how, move |given| {
        let options = NoiseOptions { interruption: given.interruption, ..options };
        let file = match read {
            Some(file) => file,
            None => Arc::new(read_for_noise(&source, &reading, &options)?),
        };
        let found = calibrant::noise(&file.recording, &options);
        let NoiseAtRest { sensors, examined, failed } =
            found.map_err(|error| error.in_recording(source.path()))?;
        let inputs = source.inputs(&file.sha256, &file.recording, sensors[0].sensor_kind);
        let mut notes: Vec<Diagnostic> = file.all_findings().cloned().collect();
        notes.extend(failed.map(|(sensor_kind, error)| {
            Diagnostic::from(NoiseImpossible { sensor_kind, why: Phrase(error.to_string()) })
        }));
        notes.extend(sensors.iter().flat_map(SensorNoise::diagnostics).cloned());
        let about = About::default();
        let json = to_json(&NoiseFile { noise: &sensors, inputs: &inputs });
        Ok(page(json, &notes, &noise_sheet(&sensors, examined.as_deref(), &about)))
    })
}

fn gains(
    name: &str,
    sensor_kind: SensorKind,
    given: Option<Gain>,
) -> Result<Option<(SensorKind, Vector3<f64>)>> {
    let gain = match given.as_deref() {
        None => return Ok(None),
        Some([all]) => Vector3::repeat(*all),
        Some([x, y, z]) => Vector3::new(*x, *y, *z),
        Some(_) => Vector3::zeros(),
    };
    if gain.iter().all(|gain| gain.is_finite() && *gain != 0.0) {
        return Ok(Some((sensor_kind, gain.abs())));
    }
    Err(invalid(
        format!("`{name}` is {given:?}"),
        "give one number or three, none of them 0: counts per m/s² or rad/s",
    ))
}
