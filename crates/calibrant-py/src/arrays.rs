//! Arrays of numpy: they come and go as the bytes of their numbers, which the package above makes arrays of. This needs no crate of arrays, and no unsafe code.

use nalgebra::Vector3;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

/// The bytes of numbers.
pub(crate) type Numbers<'py> = Bound<'py, PyByteArray>;

/// The numbers of bytes.
pub(crate) fn list(bytes: &[u8]) -> Vec<f64> {
    let (numbers, _) = bytes.as_chunks::<8>();
    numbers.iter().map(|number| f64::from_ne_bytes(*number)).collect()
}

/// The rows of a table of three columns.
pub(crate) fn vectors(bytes: &[u8]) -> Vec<Vector3<f64>> {
    let numbers = list(bytes);
    let (rows, _) = numbers.as_chunks::<3>();
    rows.iter().map(|row| Vector3::from(*row)).collect()
}

/// Numbers as bytes.
pub(crate) fn as_array<'py>(py: Python<'py>, numbers: &[f64]) -> Numbers<'py> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_ne_bytes()).collect();
    PyByteArray::new(py, &bytes)
}

/// Vectors as a table of three columns, row by row.
pub(crate) fn as_table<'py>(py: Python<'py>, vectors: &[Vector3<f64>]) -> Numbers<'py> {
    let numbers: Vec<f64> = vectors.iter().flat_map(|of| [of.x, of.y, of.z]).collect();
    as_array(py, &numbers)
}
