//! The order of the axes in a matrix.

use crate::sensor::Axis;
use nalgebra::Matrix3;

/// Is this matrix of an accelerometer that of another order of its axes?
pub(crate) fn turned_frame(matrix: &Matrix3<f64>) -> bool {
    Axis::ALL.into_iter().any(|axis| {
        let row = matrix.row(axis.index());
        row[axis.index()] < 0.5 * row.norm()
    })
}
