//! The bias of the gyroscope in a rotation, by the holds before and after it.

use crate::estimate::imu::model::{ImuModel, LocalBias, State};
use crate::sensor::SensorKind;
use nalgebra::Vector3;

/// The bias of a rotation is that of the holds before and after it, as far as these tell: a hold's deviation from the mean bias counts by the share of it that
/// is neither noise nor a turn within holds.
pub(crate) fn follow_drift(model: &mut ImuModel<'_>, state: &State, between: &Vector3<f64>) {
    let matrix = state.imu[SensorKind::Gyroscope].matrix;
    let of_turns = Vector3::from_fn(|axis, _| matrix.row(axis).norm() * model.turns_in_holds.rate_sd_radps);
    let true_variance =
        (between.component_mul(between) - of_turns.component_mul(&of_turns)).map(|v| v.max(0.0));
    let biases: Vec<LocalBias> = model
        .holds
        .iter()
        .zip(&state.forces)
        .enumerate()
        .map(|(j, (hold, force))| {
            let none = LocalBias::none(hold.temperature_c);
            hold.gyroscope.map_or(none, |(mean, weight)| LocalBias {
                mean,
                force: *force,
                rate: model.earth.rate(j, force),
                share: true_variance.component_mul(&weight),
                variance: weight.map(|weight| 1.0 / weight) - true_variance,
                ..none
            })
        })
        .collect();
    for rotation in &mut model.rotations {
        rotation.samples.drift = [biases[rotation.from], biases[rotation.from + 1]];
    }
}
