//! Vectors and matrices in the form in which files list them.

use super::words::invalid;
use calibrant_core::sensor::Axis;
use calibrant_recording::text::decoding::Checked;
use nalgebra::{Matrix3, Vector3};

/// A matrix, row by row.
pub(super) type Rows = Vec<Vec<f64>>;

/// The error for a missing field.
pub(super) fn missing(field: &str) -> Box<calibrant_core::error::InputError> {
    invalid(
        format!("this is no calibration of an IMU: the field `{field}` is missing"),
        "give a file that calibrant wrote, or name its format with option `from`",
    )
}

/// A matrix row by row.
pub(super) fn rows(matrix: &Matrix3<f64>) -> Rows {
    Axis::ALL.map(|row| matrix.row(row.index()).iter().copied().collect()).to_vec()
}

/// Three numbers.
pub(super) fn vector3(values: &[f64], field: &str) -> Checked<Vector3<f64>> {
    match values {
        [x, y, z] => Ok(Vector3::new(*x, *y, *z)),
        _ => Err(invalid(format!("`{field}` has {} numbers, not 3", values.len()), "give one for each axis")),
    }
}

/// Three rows of three numbers.
pub(super) fn matrix3(values: &[Vec<f64>], field: &str) -> Checked<Matrix3<f64>> {
    if values.len() != 3 || values.iter().any(|row| row.len() != 3) {
        return Err(invalid(format!("`{field}` is not 3 × 3"), "give three rows of three numbers"));
    }
    Ok(Matrix3::from_fn(|row, column| values[row][column]))
}
