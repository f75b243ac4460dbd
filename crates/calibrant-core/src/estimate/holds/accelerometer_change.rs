//! Does the accelerometer change from a hold on?

use super::robust::Robust;
use crate::diagnostic::{Change, Changed, Course};
use crate::estimate::HoldResult;
use crate::estimate::change::Series;
use crate::sensor::SensorKind;
use nalgebra::{DMatrix, DVector};

/// The change that the holds show in a fit without a drift, if there is one. Holds that were known to be bad before their residual say nothing.
///
/// `follows`: does the result follow a drift of the bias? It is then no change.
pub(super) fn change(holds: &[HoldResult], fit: &Robust, gravity: f64, follows: bool) -> Option<Change> {
    let (magnitudes, used) = (&fit.magnitudes, &fit.used);
    let sound: Vec<usize> = (0..holds.len()).filter(|&j| holds[j].reason.is_none()).collect();
    let (rows, columns) = (sound.len(), magnitudes.first()?.by_parameters.len());
    let of = |row: usize| &magnitudes[sound[row]];
    let sd = |row: usize| of(row).own.sqrt();
    let series = Series {
        times_s: sound.iter().map(|&j| middle(&holds[j])).collect(),
        left_out: sound.iter().map(|&j| !used[j]).collect(),
        errors: DVector::from_fn(rows, |row, _| of(row).error / sd(row)),
        parameters: DMatrix::from_fn(rows, columns, |row, k| of(row).by_parameters[k] / sd(row)),
        kinds: vec![
            (Changed::Bias, DMatrix::from_fn(rows, 3, |row, axis| of(row).along[axis] / sd(row))),
            (
                Changed::Gain,
                DMatrix::from_fn(rows, 3, |row, axis| of(row).along[axis].powi(2) * gravity / sd(row)),
            ),
        ],
    };
    let found = series.change(1)?;
    let change = Change::of(SensorKind::Accelerometer, found, |last, first| {
        let (before, after) = (sound[last], sound[first]);
        (before, after, 0.5 * (holds[before].hold.end_s + holds[after].hold.start_s))
    });
    let is_drift = change.of == Changed::Bias && change.course == Course::Drift;
    (!(is_drift && follows)).then_some(change)
}

fn middle(result: &HoldResult) -> f64 {
    0.5 * (result.hold.start_s + result.hold.end_s)
}
