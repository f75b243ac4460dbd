//! The noise of a sensor at rest.

use crate::failure::raised;
use crate::options::{Reading, parsed};
use crate::recording::sensor_kind;
use crate::source::Source;
use crate::work::{How, run_as};
use calibrant::io::{NoiseFile, to_json};
use calibrant::noise::SensorNoise;
use calibrant::report::{About, noise_sheet};
use calibrant::{NoiseAtRest, NoiseOptions, read_for_noise};
use pyo3::prelude::*;
use serde_json::json;

/// Examines a recording at rest: the text of `noise.json`, what was noticed, and the sheet as text and as a page.
#[pyfunction]
#[pyo3(signature = (source, reading, *, sensor=None, hold_s=None, threads=None, width=100))]
pub(crate) fn noise(
    py: Python<'_>,
    source: &Source,
    reading: &str,
    sensor: Option<&str>,
    hold_s: Option<(f64, f64)>,
    threads: Option<usize>,
    width: usize,
) -> PyResult<(String, String, String, String)> {
    let reading = parsed::<Reading>(reading).and_then(|reading| reading.options());
    let reading = reading.map_err(|error| raised(py, &error))?;
    let options = NoiseOptions { sensor: sensor.map(sensor_kind), hold_s, ..NoiseOptions::default() };
    let source = source.0.clone();
    let how = How { threads, ..How::default() };
    run_as(py, how, move |given| {
        let options = NoiseOptions { interruption: given.interruption, ..options };
        let file = read_for_noise(&source, &reading, &options)?;
        let found = calibrant::noise(&file.recording, &options);
        let NoiseAtRest { sensors, examined, failed } =
            found.map_err(|error| error.in_recording(source.path()))?;
        let inputs = source.inputs(&file.sha256, &file.recording, sensors[0].sensor_kind);
        let mut notes: Vec<String> = file.all_findings().map(ToString::to_string).collect();
        notes.extend(
            failed.map(|(kind, error)| format!("the noise of the {kind} is not determined: {error}")),
        );
        notes.extend(sensors.iter().flat_map(SensorNoise::diagnostics).map(ToString::to_string));
        let about = About::default();
        let sheet = noise_sheet(&sensors, examined.as_deref(), &about);
        let json = to_json(&NoiseFile { noise: &sensors, inputs: &inputs });
        Ok((json, json!(notes).to_string(), sheet.text(width), sheet.html()))
    })
}
