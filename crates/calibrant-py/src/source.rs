//! Where a recording is: a file, bytes, or arrays.

use crate::arrays::list;
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
        further: Vec<PyRef<'_, Readings>>,
        sections: Option<PathBuf>,
    ) -> Self {
        Self(GivenSource {
            recording: recording.0.clone(),
            gyroscope: gyroscope.map(|readings| readings.0.clone()),
            sections: sections.map(SectionList::File),
            further: further.iter().map(|readings| readings.0.clone()).collect(),
        })
    }
}
