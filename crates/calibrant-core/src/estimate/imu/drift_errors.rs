//! The errors of the estimates by what is not known of the accelerometer's drift.

use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::imu::model::{Fit, ImuModel};
use crate::estimate::settings::CalibrationSettings;
use nalgebra::{DVector, Vector3};

/// By how much the estimates change with each column of `L`, where `L Lᵀ` is the covariance of the drift: three fits with other means.
pub(crate) fn drift_errors(
    model: &ImuModel<'_>,
    fit: &Fit,
    holds: &HoldCalibration,
    settings: &CalibrationSettings,
) -> Vec<DVector<f64>> {
    let Some(drift) = &holds.drift else { return Vec::new() };
    let Some(root) = drift.covariance.cholesky() else { return Vec::new() };
    let parts: Vec<f64> = holds.used().map(|result| drift.part_of(&result.hold)).collect();
    let values = |fit: &Fit| {
        let values = model.quantities.iter().map(|quantity| quantity.value(&fit.state.imu));
        DVector::from_iterator(model.quantities.len(), values)
    };
    let error = |drift: Vector3<f64>| {
        let mut moved = model.clone();
        for (hold, part) in moved.holds.iter_mut().zip(&parts) {
            hold.accelerometer -= drift * *part;
        }
        let residuals = moved.gravity_residuals(&fit.state)?;
        let found = moved.fit(fit.state.clone(), residuals, settings)?;
        Some(values(&found) - values(fit))
    };
    root.l().column_iter().filter_map(|column| error(column.into_owned())).collect()
}
