//! Axes of the gyroscope that show hardly a turn in any rotation.

use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::alignment::coarse_rotations::WRONG_RAD;
use crate::estimate::imu::checks::axes_in_words::axes_in_words;
use crate::estimate::imu::model::{ImuModel, RotationData, State};
use crate::sensor::{Axis, SensorKind};

/// An axis that shows less than this in all rotations does not turn, rad. Noise and the drift of the bias show as much.
const HARDLY_RAD: f64 = 0.05;

/// Refuses them, but where gravity does not move much either.
pub(crate) fn check(model: &ImuModel<'_>, state: &State) -> Result<()> {
    let used = || model.rotations.iter().filter(|rotation| rotation.used);
    let moved = used()
        .map(|rotation| state.forces[rotation.from].angle(&state.forces[rotation.from + 1]))
        .fold(0.0, f64::max);
    let turned = |axis: &Axis| {
        let angle = |rotation: &RotationData<'_>| {
            let samples = &rotation.samples;
            let bias = state.imu.at(samples.temperature_c())[SensorKind::Gyroscope].bias[axis.index()];
            let gain = state.imu[SensorKind::Gyroscope].matrix.row(axis.index()).norm();
            let steps = samples.times_s.windows(2).zip(samples.readings);
            steps.map(|(t, y)| (t[1] - t[0]) * (y[axis.index()] - bias)).sum::<f64>().abs() / gain
        };
        used().map(angle).fold(0.0, f64::max)
    };
    let still: Vec<Axis> = Axis::ALL.into_iter().filter(|axis| turned(axis) < HARDLY_RAD).collect();
    if still.is_empty() || moved < WRONG_RAD {
        return Ok(());
    }
    let most = still.iter().map(turned).fold(0.0, f64::max);
    Err(Error::recording(InputError::new(
        Refusal::GravityMissed,
        format!(
            "the gyroscope hardly turns about its ax{} {}: by less than {:.0}° between two holds, while gravity turns by up to {:.0}°",
            if still.len() == 1 { "is" } else { "es" },
            axes_in_words(&still, ""),
            most.to_degrees().floor() + 1.0,
            moved.to_degrees()
        ),
        "are its columns the right ones, in the right unit, and of this recording? is each axis connected?",
    )))
}
