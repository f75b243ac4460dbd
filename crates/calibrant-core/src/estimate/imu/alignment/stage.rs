//! Alignment of the two sensors: a rough matrix of the gyroscope in the accelerometer's frame.

use crate::error::{Error, Result};
use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::imu::alignment::axes::Axes;
use crate::estimate::imu::alignment::search::find_alignment;
use crate::estimate::imu::checks::identifiability::undetermined;
use crate::estimate::imu::checks::missed_gravity;
use crate::estimate::imu::estimated::{set_fixed, set_usual};
use crate::estimate::imu::model::{ImuModel, State};
use crate::estimate::imu::problem::ImuProblem;
use crate::sensor::ReadingUnit;
use nalgebra::Matrix3;

/// Aligns the gyroscope: its matrix then propagates gravity through the rotations. Returns its axes if they differ from the accelerometer's.
///
/// If no rotation can be integrated, the state does not change: the turns determine the matrix.
pub(crate) fn align_sensors(
    problem: &ImuProblem<'_>,
    model: &ImuModel<'_>,
    mut state: State,
    holds: &HoldCalibration,
) -> Result<(State, Option<Axes>)> {
    let none = || Error::NotIdentifiable(Box::new(undetermined(model, &[])));
    if model.rotations.iter().all(|rotation| !rotation.used) {
        return if model.turns.is_empty() { Err(none()) } else { Ok((state, None)) };
    }
    let nominal = match (problem.gyroscope.unit, problem.gyroscope.gain) {
        (ReadingUnit::Counts, gain) => gain.map(|gain| Matrix3::from_diagonal(&gain)),
        _ => Some(Matrix3::identity()),
    };
    let found = find_alignment(model, &state, problem.gyroscope.unit, nominal).ok_or_else(none)?;
    missed_gravity::check(model, &state, found.median_rad, problem.gyroscope.unit, holds)?;
    state.imu = found.imu;
    if found.axes.is_none() {
        set_usual(&mut state.imu, problem.setup);
    }
    set_fixed(&mut state.imu, problem.setup);
    Ok((state, found.axes))
}
