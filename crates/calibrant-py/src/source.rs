//! Where a recording is: a file, bytes, or arrays.

use crate::arrays::{list, vectors};
use crate::work::at_once;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::ImuFile;
use calibrant::sensor::{ImuRecording, ReadingUnit, Recording as Samples, SensorKind};
use calibrant::session::{Readings as Given, SectionList, Source as GivenSource};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use std::path::PathBuf;

/// The readings of a file, of bytes or of columns.
#[pyclass(frozen)]
#[derive(Clone)]
pub(crate) struct Readings(pub(crate) Given);

#[pymethods]
impl Readings {
    #[staticmethod]
    fn file(path: PathBuf) -> Self {
        Self(Given::file(path))
    }

    #[staticmethod]
    fn bytes(name: PathBuf, bytes: Vec<u8>) -> Self {
        Self(Given::bytes(name, bytes))
    }

    #[staticmethod]
    fn columns(name: PathBuf, columns: Vec<(String, PyBackedBytes)>) -> Self {
        let columns: Vec<(&str, Vec<f64>)> =
            columns.iter().map(|(name, values)| (name.as_str(), list(values))).collect();
        let columns: Vec<(&str, &[f64])> =
            columns.iter().map(|(name, values)| (*name, values.as_slice())).collect();
        Self(Given::columns(name, &columns))
    }

    /// Samples as they are: sensor, unit, times in s and readings of each; the number of axes; temperatures in °C; how well the rate of the clock is known, ppm.
    #[staticmethod]
    #[pyo3(signature = (name, sensors, axes, temperature_c=None, rate_sd_ppm=None))]
    fn samples(
        py: Python<'_>,
        name: PathBuf,
        sensors: Vec<(String, String, PyBackedBytes, PyBackedBytes)>,
        axes: usize,
        temperature_c: Option<&[u8]>,
        rate_sd_ppm: Option<f64>,
    ) -> PyResult<Self> {
        at_once(py, || {
            let temperature_c = temperature_c.map(list);
            let mut recording = ImuRecording { temperature_c, ..ImuRecording::default() };
            for (sensor, unit, times_s, readings) in &sensors {
                let unit = ReadingUnit::ALL.into_iter().find(|known| known.symbol() == unit);
                let unit = unit.unwrap_or(ReadingUnit::Counts);
                let axes = if sensor == "gyroscope" { 3 } else { axes };
                let samples = Samples::new(list(times_s), vectors(readings), axes, unit)?;
                if samples.len() < 2 {
                    let message = format!("the {sensor} has {} samples", samples.len());
                    let input_error = InputError::new(Refusal::RecordingShort, message, "give two at least");
                    return Err(Error::recording(input_error));
                }
                match sensor.as_str() {
                    "gyroscope" => recording[SensorKind::Gyroscope] = Some(samples),
                    _ => recording[SensorKind::Accelerometer] = Some(samples),
                }
            }
            let file = ImuFile { rate_sd_ppm, ..ImuFile::of_recording(recording) };
            Ok(Self(Given::read_already(name, file)))
        })
    }
}

/// A recording, with what belongs to it.
#[pyclass(frozen)]
#[derive(Clone)]
pub(crate) struct Source(pub(crate) GivenSource);

#[pymethods]
impl Source {
    #[new]
    #[pyo3(signature = (recording, gyroscope=None, further=Vec::new(), sections=None))]
    fn new(
        recording: &Readings,
        gyroscope: Option<&Readings>,
        further: Vec<PyRef<'_, Self>>,
        sections: Option<PathBuf>,
    ) -> Self {
        Self(GivenSource {
            recording: recording.0.clone(),
            gyroscope: gyroscope.map(|readings| readings.0.clone()),
            sections: sections.map(SectionList::File),
            further: further.iter().map(|source| source.0.clone()).collect(),
        })
    }
}
