//! Weights and least squares: the estimate.
//!
//! A prior adds information and weighs nothing: the weights are those of the recording alone, where it determines all quantities.

use crate::error::Result;
use crate::estimate::imu::checks::identifiability;
use crate::estimate::imu::model::{Fit, GravityResiduals, ImuModel, State, singular};
use crate::estimate::imu::variance_components::between_holds::Means;
use crate::estimate::imu::variance_components::iteration::{apply, variance_components};
use crate::estimate::imu::variance_components::linear_problem::{reweigh, with_same_weights};
use crate::estimate::imu::variance_components::rotations::RotationWeights;
use crate::estimate::settings::CalibrationSettings;
use crate::solve::CalibrationStatus;
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

/// The estimate from a state that is close.
pub(crate) fn solve(
    model: &mut ImuModel<'_>,
    start: (State, GravityResiduals),
    means: &Means<'_>,
    between: Vector3<f64>,
    settings: &CalibrationSettings,
) -> Result<Solution> {
    let Some(prior) = model.prior.take() else {
        return estimate(model, start, means, between, settings);
    };
    let state = start.0.clone();
    let alone = model.linearised(&state, settings)?;
    if identifiability::check(model, &state, &alone).is_ok()
        && let Ok(Solution { fit, weighed, between }) = estimate(model, start, means, between, settings)
    {
        model.prior = Some(prior.clone());
        let fit = model.fit(fit.state, fit.residuals, settings).ok_or_else(singular)?;
        if fit.status == CalibrationStatus::Converged {
            let weighed = with_same_weights(model, &fit.state, &fit.residuals, weighed)?;
            return Ok(Solution { fit, weighed, between });
        }
    }
    // the recording leaves something open, or contradicts the prior by far
    model.prior = Some(prior);
    let residuals = model.gravity_residuals(&state).ok_or_else(singular)?;
    estimate(model, (state, residuals), means, between, settings)
}

/// Variance components with directions fixed, least squares of all, and the rotations' weights once more where directions and parameters go together.
fn estimate(
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
    let (now, before_it) = (weighed.scatter.between_sd_rad, model.rotation_scatter.between_sd_rad);
    let moved = (now - before_it).abs() > 0.01 * before_it
        || weighed.scatter.own_factors != model.rotation_scatter.own_factors;
    if moved || weighed.used != before.used {
        apply(model, &weighed);
    }
    let fit = model.fit(close.state, close.residuals, settings).ok_or_else(singular)?;
    Ok(Solution { fit, weighed, between })
}
