//! The solution for a given clock: one chain for each axis of a scale-bias sensor, one for all of a full one.

use super::chain::{Solved, solve};
use super::context::Context;
use crate::error::{Error, NotIdentifiable, Result, UndeterminedGroup};
use crate::information::chain_model::FULL_SLOTS;
use crate::sensor::SensorModel;

/// The solution for a given clock.
pub(super) fn solve_at(context: &Context<'_>) -> Result<Solved> {
    match context.problem.sensor.model {
        SensorModel::ScaleBias => solve_axes(context),
        SensorModel::Full => {
            let whole = solve::<3, 12, 14>(context, [0, 1, 2], FULL_SLOTS).map_err(not_identifiable)?;
            Ok(Solved::merge(vec![whole]))
        }
    }
}

fn not_identifiable(groups: Vec<UndeterminedGroup>) -> Error {
    Error::NotIdentifiable(Box::new(NotIdentifiable { groups }))
}

/// The scale-bias model: one chain per axis. Undetermined parameters of all axes are collected in one error.
fn solve_axes(context: &Context<'_>) -> Result<Solved> {
    let axes = context.problem.sensor.axes;
    let mut parts = Vec::with_capacity(axes);
    let mut undetermined = Vec::new();
    for axis in 0..axes {
        match solve::<1, 2, 4>(context, [axis], [axis, axes + axis]) {
            Ok(part) => parts.push(part),
            Err(groups) => undetermined.extend(groups),
        }
    }
    if undetermined.is_empty() { Ok(Solved::merge(parts)) } else { Err(not_identifiable(undetermined)) }
}
