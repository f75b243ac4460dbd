//! The variance of a hold's mean reading of the accelerometer, per axis.

use crate::motion::Hold;
use nalgebra::{Matrix3, Vector3};

/// By the noise in it: that of its samples, and what more of them do not lower.
pub(super) fn noise_variance(hold: &Hold, within: &Vector3<f64>, of_mean: &Vector3<f64>) -> Vector3<f64> {
    within.component_mul(within) / hold.samples() as f64 + of_mean
}

/// By a scatter of the force between holds, m/s². The gain of a reading is the norm of its row of `S`, whatever the gauge.
pub(super) fn between_variance(between: f64, s: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| s.row(axis).norm_squared()) * between.powi(2)
}
