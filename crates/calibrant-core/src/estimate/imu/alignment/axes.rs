//! The axes of a gyroscope in the accelerometer's frame.

use crate::sensor::Axis;
use nalgebra::Matrix3;

/// The axes of a gyroscope in the accelerometer's frame.
pub(crate) enum Axes {
    /// The axes along the accelerometer's x, y and z, such as `-y`.
    InOrder([String; 3]),
    /// Rotated by some angle.
    Rotated,
}

/// All orders and signs of three axes.
pub(crate) fn orders() -> [Matrix3<f64>; 48] {
    let permutations = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    std::array::from_fn(|k| {
        let (permutation, signs) = (permutations[k / 8], k % 8);
        Matrix3::from_fn(|row, column| {
            let sign = if signs >> row & 1 == 0 { 1.0 } else { -1.0 };
            if permutation[row] == column { sign } else { 0.0 }
        })
    })
}

/// The gyroscope's axis along each of the accelerometer's.
pub(crate) fn axis_names(matrix: &Matrix3<f64>) -> [String; 3] {
    std::array::from_fn(|column| {
        let row = matrix.column(column).iamax();
        let sign = if matrix[(row, column)] < 0.0 { "-" } else { "" };
        format!("{sign}{}", Axis::ALL[row])
    })
}
