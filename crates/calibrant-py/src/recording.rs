//! A recording that was read: its samples, and what was noticed.

use crate::arrays::{Numbers, as_array, as_table};
use crate::failure::raised;
use crate::options::{Reading, parsed};
use crate::page::{Page, page};
use crate::source::{Readings, Source};
use crate::work::run;
use calibrant::diagnostic::Diagnostic;
use calibrant::inspection::recording_sheet;
use calibrant::io::{
    ImuFile, InspectionFile, file_name, inspect, to_json, write_imu_recording, write_recording,
};
use calibrant::sensor::{ImuRecording, SensorKind};
use calibrant::session::{Readings as Given, Source as GivenSource};
use pyo3::prelude::*;
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;

/// Times, readings and unit of a sensor.
pub(crate) type Samples<'py> = (Numbers<'py>, Numbers<'py>, &'static str);

/// The samples of a sensor, where there are some.
pub(crate) fn samples<'py>(
    py: Python<'py>,
    recording: &ImuRecording,
    sensor_kind: SensorKind,
) -> Option<Samples<'py>> {
    recording
        .sensor(sensor_kind)
        .map(|of| (as_array(py, of.times_s()), as_table(py, of.readings()), of.unit().symbol()))
}

/// The sensor of this name.
pub(crate) fn sensor_kind(name: &str) -> SensorKind {
    if name == "gyroscope" { SensorKind::Gyroscope } else { SensorKind::Accelerometer }
}

/// A recording that was read.
#[pyclass(frozen)]
pub(crate) struct Recording {
    source: GivenSource,
    file: Arc<ImuFile>,
}

/// Reads a recording.
#[pyfunction]
pub(crate) fn read_recording(py: Python<'_>, source: &Source, reading: &str) -> PyResult<Recording> {
    let reading = parsed::<Reading>(reading).and_then(|reading| reading.options());
    let options = reading.map_err(|error| raised(py, &error))?;
    let source = source.0.clone();
    run(py, move || {
        let file = Arc::new(source.read_imu(&options)?);
        Ok(Recording { source, file })
    })
}

#[pymethods]
impl Recording {
    /// Times in s, readings, unit of a sensor.
    fn samples<'py>(&self, py: Python<'py>, sensor: &str) -> Option<Samples<'py>> {
        samples(py, &self.file.recording, sensor_kind(sensor))
    }

    /// Temperatures, °C.
    fn temperature_c<'py>(&self, py: Python<'py>) -> Option<Numbers<'py>> {
        self.file.recording.temperature_c.as_ref().map(|of| as_array(py, of))
    }

    /// What the reader noticed, its format, how well the rate of its clock is known, and the hash of each file.
    fn about(&self) -> String {
        let of = &self.file;
        json!({
            "findings": self.findings(), "format": of.format.name(), "rate_sd_ppm": of.rate_sd_ppm, "sha256": of.sha256,
            "axes": of.recording[SensorKind::Accelerometer].as_ref().map_or(3, |of| of.axes()),
        })
        .to_string()
    }

    /// It, beside another recording: it keeps its units and its clock.
    fn readings(&self, name: PathBuf) -> Readings {
        Readings(Given::read_already(name, self.file.as_ref().clone()))
    }

    /// What it contains.
    fn inspect(&self, py: Python<'_>) -> PyResult<Page> {
        let file = Arc::clone(&self.file);
        let names: Vec<String> = self.source.files().map(file_name).collect();
        let of_reader = self.findings();
        run(py, move || {
            let mut inspection = inspect(&file);
            // the same, with the names of their files
            inspection.findings.splice(..of_reader.len(), of_reader);
            let json = to_json(&InspectionFile { file: &file, inspection: &inspection });
            Ok(page(json, &inspection.findings, &recording_sheet(&file, &inspection, &names)))
        })
    }

    /// Writes it as CSV.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let file = Arc::clone(&self.file);
        run(py, move || match file.recording.accelerometer_alone() {
            Some(alone) => write_recording(&path, alone),
            None => write_imu_recording(&path, &file.recording),
        })
    }
}

impl Recording {
    pub(crate) fn file(&self) -> Arc<ImuFile> {
        Arc::clone(&self.file)
    }

    fn findings(&self) -> Vec<Diagnostic> {
        let gyroscope = self.source.gyroscope.as_ref().map(|of| file_name(of.path()));
        self.file.findings_in(&file_name(self.source.path()), gyroscope.as_deref())
    }
}
