//! Weights, the gyroscope's parameters and the Earth's rate in turn, directions fixed, until all rest.

use crate::error::Result;
use crate::estimate::imu::model::{GravityResiduals, HoldData, ImuModel, State, singular};
use crate::estimate::imu::variance_components::between_holds::{
    Explanation, Means, between_sd, set_gyroscope_means,
};
use crate::estimate::imu::variance_components::bias_drift::follow_drift;
use crate::estimate::imu::variance_components::linear_problem::reweigh;
use crate::estimate::imu::variance_components::rotations::RotationWeights;
use crate::sensor::SensorKind;
use nalgebra::Vector3;

/// Rounds in which weights and estimate follow each other.
const ROUNDS: usize = 12;

/// The rounds end with a step below this many standard deviations.
const CLOSE: f64 = 0.1;

pub(crate) fn apply(model: &mut ImuModel<'_>, weighed: &RotationWeights) {
    model.rotation_scatter = weighed.scatter.clone();
    for (rotation, used) in model.rotations.iter_mut().zip(&weighed.used) {
        rotation.counts = *used;
    }
}

/// The scatter of the holds beyond what the Earth's rate explains, and their weights with it.
fn scatter(model: &mut ImuModel<'_>, state: &State, means: &Means<'_>) -> Vector3<f64> {
    let of_earth = |(j, hold): (usize, &HoldData)| {
        model.earth.of_hold(j, &state.imu.at(hold.temperature_c), &state.forces[j])
    };
    let by_earth = model.holds.iter().enumerate().map(of_earth).collect();
    let given = |(hold, force): (&HoldData, &Vector3<f64>)| {
        state.imu.at(hold.temperature_c)[SensorKind::Gyroscope].matrix * force * model.earth.given()
    };
    let is_felt = means.by.forces.is_some();
    let of_earth = (!is_felt).then(|| model.holds.iter().zip(&state.forces).map(given).collect());
    let by = Explanation { of_earth, by_earth, ..means.by.clone() };
    let (between, _) = between_sd(&Means { by, ..*means });
    set_gyroscope_means(&mut model.holds, means.readings, means.noise, &between);
    between
}

/// Weights, the gyroscope's parameters and the Earth's rate in turn, directions fixed, until all rest.
///
/// `residuals` are those of the state; those of the state that it leads to are given back.
pub(crate) fn variance_components(
    model: &mut ImuModel<'_>,
    state: &mut State,
    mut residuals: GravityResiduals,
    means: &Means<'_>,
    between: &mut Vector3<f64>,
) -> Result<(RotationWeights, GravityResiduals)> {
    let places = model.gyroscope_places();
    let mut last = RotationWeights::none(model.rotations.len());
    for _ in 0..ROUNDS {
        model.earth.follow(&model.rotations, &residuals, &state.forces);
        let weighed = reweigh(model, state, &residuals)?;
        apply(model, &weighed);
        last = weighed;
        // the fit that follows takes a step this short by itself
        if last.length < CLOSE {
            break;
        }
        for (&k, step) in places.iter().zip(last.step.iter()) {
            model.quantities[k].add_to(&mut state.imu, *step);
        }
        model.earth.step(last.step.iter().skip(places.len()).copied());
        *between = scatter(model, state, means);
        follow_drift(model, state, between);
        residuals = model.gravity_residuals(state).ok_or_else(singular)?;
    }
    Ok((last, residuals))
}
