//! Weights and least squares: the estimate.

use crate::error::Result;
use crate::estimate::imu::model::{Fit, GravityResiduals, ImuModel, State, singular};
use crate::estimate::imu::variance_components::between_holds::Means;
use crate::estimate::imu::variance_components::iteration::{apply, variance_components};
use crate::estimate::imu::variance_components::linear_problem::reweigh;
use crate::estimate::imu::variance_components::rotations::RotationWeights;
use crate::estimate::settings::CalibrationSettings;
use nalgebra::Vector3;

/// Tolerance of a fit that another follows, in standard deviations.
const ROUGH: f64 = 1e-2;

/// The estimate, with the weights that it was made with.
pub(crate) struct Solution {
    pub(crate) fit: Fit,
    /// The rotations' weights at a state that is close.
    pub(crate) weighed: RotationWeights,
    /// Scatter of the gyroscope's means between holds.
    pub(crate) between: Vector3<f64>,
}

/// Variance components with directions fixed, least squares of all, and the rotations' weights once more where directions and parameters go together.
pub(crate) fn solve(
    model: &mut ImuModel<'_>,
    (mut state, residuals): (State, GravityResiduals),
    means: &Means<'_>,
    mut between: Vector3<f64>,
    settings: &CalibrationSettings,
) -> Result<Solution> {
    let (before, residuals) = variance_components(model, &mut state, residuals, means, &mut between)?;
    let rough = CalibrationSettings { tolerance: ROUGH, ..settings.clone() };
    let close = model.fit(state, residuals, &rough).ok_or_else(singular)?;
    let weighed = reweigh(model, &close.state, &close.residuals)?;
    let moved = (weighed.between_rotations_sd_rad - model.between_rotations_sd_rad).abs()
        > 0.01 * model.between_rotations_sd_rad;
    if moved || weighed.used != before.used {
        apply(model, &weighed);
    }
    let fit = model.fit(close.state, close.residuals, settings).ok_or_else(singular)?;
    Ok(Solution { fit, weighed, between })
}
