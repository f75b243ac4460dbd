//! All gains of the gyroscope off by one factor: another sample rate, the sensitivity of another range, another unit.

use crate::diagnostic::gyroscope::GyroscopeScaled;
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::alignment::coarse_rotations::{CoarseRotations, WRONG_RAD};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::model::{ImuModel, State};
use crate::sensor::{Axis, ImuQuantity, Quantity, ReadingUnit, SensorKind};
use nalgebra::{Matrix3, Vector3};

/// Logarithm of a factor that is not that of a sensor: gyroscopes are off by 1 to 5 %.
const FACTOR: f64 = 0.05;
/// The gains differ from the factor by less than this share of its logarithm. Those of a sensor would differ by as much as they are off.
const ALIKE: f64 = 1.0 / 3.0;
/// Ratio of the factors that are tried, and their number on each side of 1: up to 10.
const STEP: f64 = 1.04;
const TRIED: i32 = 59;
/// Fewest rotations: one of 119 factors fits half of them within [`WRONG_RAD`] by chance once in 400 times.
const ENOUGH_ROTATIONS: usize = 6;

/// Refuses rotations with which gravity is met if all readings are divided by one factor.
pub(crate) fn check(model: &ImuModel<'_>, state: &State) -> Result<()> {
    let rotations = CoarseRotations::of(model, state);
    let judged =
        |factor: f64| Some((rotations.judge(&Matrix3::from_diagonal_element(factor))?.median_rad, factor));
    let best =
        (-TRIED..=TRIED).filter_map(|k| judged(STEP.powi(k))).min_by(|one, other| one.0.total_cmp(&other.0));
    let Some((_, factor)) =
        best.filter(|(median_rad, _)| *median_rad <= WRONG_RAD && rotations.len() >= ENOUGH_ROTATIONS)
    else {
        return Ok(());
    };
    let found = |k: i32| judged(factor * 1.005_f64.powi(k));
    let factor = (-8..=8)
        .filter_map(found)
        .min_by(|one, other| one.0.total_cmp(&other.0))
        .map_or(factor, |(_, factor)| factor);
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
    let (problem, matrix) = (evidence.problem, &evidence.calibration.imu.gyroscope.matrix);
    let nominal = match problem.gyroscope.unit {
        ReadingUnit::Counts => problem.gyroscope.gain,
        _ => Some(Vector3::repeat(1.0)),
    };
    let is_known =
        problem.setup.known.iter().any(|known| {
            matches!(known.quantity, ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Scale(_)))
        });
    let Some(nominal) = nominal.filter(|_| !is_known) else { return Vec::new() };
    let logarithms = Axis::ALL.map(|axis| (matrix.row(axis.index()).norm() / nominal[axis.index()]).ln());
    let mean = logarithms.iter().sum::<f64>() / 3.0;
    let is_common = logarithms.iter().all(|of_axis| (of_axis - mean).abs() < ALIKE * mean.abs());
    let found = is_common && mean.abs() > FACTOR;
    found.then(|| GyroscopeScaled { factor: mean.exp() }.into()).into_iter().collect()
}
