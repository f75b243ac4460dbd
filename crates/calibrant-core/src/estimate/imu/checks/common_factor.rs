//! All gains of the gyroscope off by one factor: another sample rate, the sensitivity of another range, another unit.

use crate::diagnostic::gyroscope::GyroscopeScaled;
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::datasheet::{FACTOR, common_factor};
use crate::estimate::imu::alignment::coarse_rotations::{CoarseRotations, WRONG_RAD};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::model::{ImuModel, State};
use crate::sensor::{ImuQuantity, Quantity, ReadingUnit, SensorKind};
use nalgebra::{Matrix3, Vector3};

/// Ratio of the factors that are tried, and their number on each side of 1: up to 10.
const STEP: f64 = 1.04;
const TRIED: i32 = 59;
/// Fewest rotations: one of 119 factors fits half of them within [`WRONG_RAD`] by chance once in 400 times.
const ENOUGH_ROTATIONS: usize = 6;

/// A factor tells something where the rotation error with it is at most this share of that as the readings are.
const MARGIN: f64 = 0.5;

/// The factor of all readings with which gravity is met best, and the median rotation error with it, rad.
pub(crate) fn best(rotations: &CoarseRotations) -> Option<(f64, f64)> {
    let judged =
        |factor: f64| Some((rotations.judge(&Matrix3::from_diagonal_element(factor))?.median_rad, factor));
    let least = |one: &(f64, f64), other: &(f64, f64)| one.0.total_cmp(&other.0);
    let (_, coarse) = (-TRIED..=TRIED).filter_map(|k| judged(STEP.powi(k))).min_by(least)?;
    (-8..=8).filter_map(|k| judged(coarse * 1.005_f64.powi(k))).min_by(least)
}

/// Refuses rotations with which gravity is met if all readings are divided by one factor. `as_read_rad`: the median rotation error of the readings as they are, rad.
pub(crate) fn check(model: &ImuModel<'_>, state: &State, as_read_rad: f64) -> Result<()> {
    let rotations = CoarseRotations::of(model, state);
    let tells = |(median_rad, factor): &(f64, f64)| {
        *median_rad <= f64::min(WRONG_RAD, MARGIN * as_read_rad) && factor.ln().abs() > FACTOR
    };
    let found = best(&rotations).filter(tells).filter(|_| rotations.len() >= ENOUGH_ROTATIONS);
    let Some((_, factor)) = found else { return Ok(()) };
    Err(Error::recording(InputError::new(
        Refusal::GyroscopeScaled,
        format!("the gyroscope reads {factor:.3} times the turns that gravity shows"),
        format!(
            "is the sample rate {factor:.3} times the one that was used, or was the sensitivity of another range used, or another unit?"
        ),
    )))
}

/// The factor of the fitted gains.
pub(crate) fn of_fit(evidence: &Evidence<'_>) -> Diagnostics {
    let (problem, matrix) = (evidence.problem, &evidence.calibration.imu[SensorKind::Gyroscope].matrix);
    let nominal = match problem.gyroscope.unit {
        ReadingUnit::Counts => problem.gyroscope.gain,
        _ => Some(Vector3::repeat(1.0)),
    };
    let is_known = problem
        .setup
        .known_terms()
        .any(|known| matches!(known.quantity, ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Scale(_))));
    let Some(nominal) = nominal.filter(|_| !is_known) else { return Vec::new() };
    let found = common_factor(matrix, &nominal);
    found.map(|factor| GyroscopeScaled { factor }.into()).into_iter().collect()
}
