//! The covariance of parameters divided by their scales.

use nalgebra::{DMatrix, DVector};

/// `C_ij / (s_i s_j)`.
pub(super) fn scaled(covariance: &DMatrix<f64>, scale: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(scale.len(), scale.len(), |i, j| covariance[(i, j)] / (scale[i] * scale[j]))
}
