//! The search for the gyroscope's gain and the order of its axes, without a datasheet.
//!
//! A rotation turns gravity at most by the angle of the gyroscope's path. So each rotation bounds the gain from above, and a rotation about an axis
//! across gravity reaches the bound. The search tries gains from that bound downwards. If none propagates gravity correctly, it tries all orders
//! and signs of the axes, then all attitudes (`mounting`).

use crate::estimate::imu::alignment::axes::{Axes, axis_names, orders};
use crate::estimate::imu::alignment::coarse_rotations::{CoarseRotations, Judged, WRONG_RAD};
use crate::estimate::imu::alignment::mounting::find_mounting;
use crate::estimate::imu::checks::common_factor;
use crate::estimate::imu::model::{ImuModel, State};
use crate::sensor::{ImuParameters, ReadingUnit, SensorKind};
use nalgebra::Matrix3;
use rayon::prelude::*;

/// Fewest rotations that no wrong order of the axes fits by chance. Three of four within [`WRONG_RAD`] of one of 48 orders happens once in 5000 times.
const ENOUGH_ROTATIONS: usize = 4;

/// Number of rotations with errors beyond a right angle that is not by chance.
const SEVERAL_UPSIDE_DOWN: usize = 2;

/// An order of the axes is found where the rotation error with any other is larger by this factor.
const MARGIN: f64 = 1.5;

/// Number of gains that the search tries.
const GAINS_TRIED: usize = 16;

/// Ratio of a gain to the one before.
const GAIN_STEP: f64 = 0.92;

/// A start, and its median rotation error, rad.
pub(crate) struct Alignment {
    pub(crate) imu: ImuParameters,
    pub(crate) median_rad: f64,
    /// The gyroscope's axes, if they differ from the accelerometer's.
    pub(crate) axes: Option<Axes>,
}

/// Finds a start. `nominal` is the gyroscope's matrix by its datasheet (the identity for rad/s), where it is known.
pub(crate) fn find_alignment(
    model: &ImuModel<'_>,
    state: &State,
    unit: ReadingUnit,
    nominal: Option<Matrix3<f64>>,
) -> Option<Alignment> {
    let with = |matrix: Matrix3<f64>| {
        let mut imu = state.imu;
        imu[SensorKind::Gyroscope].matrix = matrix;
        imu
    };
    let look = CoarseRotations::of(model, state);
    let judged = |matrix: Matrix3<f64>| Some((look.judge(&matrix)?, matrix));
    let best = |tries: &[Matrix3<f64>]| {
        tries
            .par_iter()
            .filter_map(|matrix| judged(*matrix))
            .min_by(|(one, _), (other, _)| one.median_rad.total_cmp(&other.median_rad))
    };
    // the axis with fewer rotations about it may be the reversed one
    let fewer_upside_down = |matrix: &Matrix3<f64>, before: usize| {
        if before < SEVERAL_UPSIDE_DOWN {
            return None;
        }
        orders()
            .par_iter()
            .filter_map(|order| judged(order * matrix))
            .filter(|(look, _)| {
                SEVERAL_UPSIDE_DOWN * look.upside_down <= before && look.median_rad <= WRONG_RAD
            })
            .min_by(|(one, _), (other, _)| {
                one.upside_down.cmp(&other.upside_down).then(one.median_rad.total_cmp(&other.median_rad))
            })
            .map(|(look, matrix)| Alignment {
                imu: with(matrix),
                median_rad: look.median_rad,
                axes: Some(Axes::InOrder(axis_names(&matrix))),
            })
    };
    let turned = |gains: &[Matrix3<f64>], is_scaled: bool| {
        let (median_rad, matrix) = find_mounting(&look, gains, is_scaled)?;
        (median_rad <= WRONG_RAD).then(|| Alignment {
            imu: with(matrix),
            median_rad,
            axes: Some(Axes::Rotated),
        })
    };
    if let Some(matrix) = nominal {
        let imu = with(matrix);
        let Judged { median_rad, upside_down } = look.judge(&matrix)?;
        let as_it_is = Alignment { imu, median_rad, axes: None };
        // few rotations fit some order by chance
        let few = model.rotations.iter().filter(|data| data.used).count() < ENOUGH_ROTATIONS;
        if median_rad <= WRONG_RAD || (unit != ReadingUnit::Counts && few) {
            return Some(fewer_upside_down(&matrix, upside_down).filter(|_| !few).unwrap_or(as_it_is));
        }
        if unit != ReadingUnit::Counts {
            let mut tried: Vec<_> = orders().iter().filter_map(|order| judged(order * matrix)).collect();
            tried.sort_by(|(one, _), (other, _)| one.median_rad.total_cmp(&other.median_rad));
            let &(Judged { median_rad, .. }, found) = tried.first()?;
            // of orders that fit alike none is found
            let is_alone = tried.get(1).is_none_or(|(second, _)| second.median_rad > MARGIN * median_rad);
            if median_rad <= WRONG_RAD && is_alone {
                return Some(Alignment {
                    imu: with(found),
                    median_rad,
                    axes: Some(Axes::InOrder(axis_names(&found))),
                });
            }
            let Some(turned) = turned(&[matrix], false) else { return Some(as_it_is) };
            // where one factor of all gains fits better, nothing is turned
            let scaled = common_factor::best(&look).filter(|(median_rad, _)| *median_rad < turned.median_rad);
            return Some(scaled.map_or(turned, |(median_rad, factor)| Alignment {
                imu: with(matrix * factor),
                median_rad,
                axes: None,
            }));
        }
    }
    let largest = gain_bound(model, state)?;
    let gains: Vec<f64> = (0..GAINS_TRIED).map(|k| 1.1 * largest * GAIN_STEP.powi(k as i32)).collect();
    let scaled = |orders: &[Matrix3<f64>]| -> Vec<Matrix3<f64>> {
        orders.iter().flat_map(|order| gains.iter().map(move |gain| order * *gain)).collect()
    };
    let (mut found, mut matrix) = best(&scaled(&[Matrix3::identity()]))?;
    let mut axes = None;
    if found.median_rad > WRONG_RAD {
        let better = best(&scaled(&orders())).filter(|(other, _)| other.median_rad < 0.5 * found.median_rad);
        if let Some(other) = better {
            (found, matrix) = other;
            axes = Some(Axes::InOrder(axis_names(&matrix)));
        }
    }
    if found.median_rad > WRONG_RAD {
        let some: Vec<Matrix3<f64>> = gains
            .iter()
            .step_by(2)
            .take(GAINS_TRIED / 3)
            .map(|gain| Matrix3::from_diagonal_element(*gain))
            .collect();
        if let Some(turned) = turned(&some, true) {
            return Some(turned);
        }
    }
    let Judged { median_rad, upside_down } = found;
    let upright = if median_rad <= WRONG_RAD { fewer_upside_down(&matrix, upside_down) } else { None };
    Some(upright.unwrap_or_else(|| Alignment { imu: with(matrix), median_rad, axes }))
}

/// The largest gain that no rotation contradicts, a few outliers apart.
fn gain_bound(model: &ImuModel<'_>, state: &State) -> Option<f64> {
    let mut bounds: Vec<f64> = model
        .rotations
        .iter()
        .filter(|data| data.used)
        .filter_map(|data| {
            let angle = state.forces[data.from].angle(&state.forces[data.from + 1]);
            let samples = &data.samples;
            let bias = state.imu.at(samples.temperature_c())[SensorKind::Gyroscope].bias;
            let path: f64 = samples
                .times_s
                .windows(2)
                .zip(samples.readings)
                .map(|(t, y)| (t[1] - t[0]) * (y - bias).norm())
                .sum();
            (angle > 0.2).then_some(path / angle)
        })
        .collect();
    bounds.sort_by(f64::total_cmp);
    bounds.get(bounds.len() / 10).copied().filter(|bound| *bound > 0.0)
}
