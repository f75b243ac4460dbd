//! The errors of the estimates by what is not known of the accelerometer's drift.

use crate::error::Result;
use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::imu::model::{Fit, ImuModel, singular};
use nalgebra::{DVector, Vector3};

/// By how much the estimates change with each column of `L`, where `L Lᵀ` is the covariance of the drift: a step with other means.
///
/// Other means of the holds leave the residuals of the rotations as they are.
pub(crate) fn drift_errors(
    model: &ImuModel<'_>,
    fit: &Fit,
    holds: &HoldCalibration,
) -> Result<Vec<DVector<f64>>> {
    let Some(drift) = &holds.drift else { return Ok(Vec::new()) };
    let Some(root) = drift.covariance.cholesky() else { return Ok(Vec::new()) };
    let parts: Vec<f64> = holds.used().map(|result| drift.part_of(&result.hold)).collect();
    let mut moved = model.clone();
    let mut step = |drift: Vector3<f64>| {
        for ((hold, before), part) in moved.holds.iter_mut().zip(&model.holds).zip(&parts) {
            hold.accelerometer = before.accelerometer - drift * *part;
        }
        moved.step(&fit.state, &fit.residuals).ok_or_else(singular)
    };
    let rest = step(Vector3::zeros())?;
    root.l().column_iter().map(|column| Ok(step(column.into_owned())? - &rest)).collect()
}
