//! Where the iteration begins: the gyroscope's gain and the order of its axes, where the datasheet does not say.
//!
//! A rotation turns gravity by no more than the angle that the gyroscope went through, so each rotation bounds the gain from above, and one about an axis
//! across gravity gives it. From that bound downwards gains are tried, and if none brings gravity back, all orders and signs of the axes, then all attitudes (`tilted`).

use super::joint::{HoldData, Joint, RotationData, State};
use super::rotation::carried_back;
use super::tilted;
use crate::estimate::holds::median;
use crate::sensor::{Axis, ImuParameters, ReadingUnit, Thermal};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Median error of a rotation beyond which something is wrong with units or axes, rad.
pub(super) const WRONG: f64 = 0.2;
/// Rotations that no wrong order of the axes fits by chance: three of four within [`WRONG`] for one of 48 orders happens once in 5000 times.
const ENOUGH: usize = 4;
/// So many rotations that end upside down are no single faults.
const SEVERAL: usize = 2;
/// Gains that are tried: so many, each smaller by this factor.
const GAINS: usize = 16;
const FACTOR: f64 = 0.92;
/// A rotation is cut down to about so many samples for a first look.
const SAMPLES: usize = 150;

/// A start, and the median error of the rotations with it, rad.
pub(super) struct Start {
    pub(super) imu: ImuParameters,
    pub(super) median_rad: f64,
    /// The gyroscope's axes, where they are not the accelerometer's.
    pub(super) axes: Option<Axes>,
}

/// How the axes of a gyroscope lie in the accelerometer's frame.
pub(super) enum Axes {
    /// Those along the accelerometer's x, y and z: `-y`.
    InOrder([String; 3]),
    /// Turned by some angle.
    Turned,
}

/// Finds a start. `nominal` is the gyroscope's matrix by its datasheet (the identity for rad/s), where it is known.
pub(super) fn find(
    joint: &Joint<'_>,
    state: &State,
    unit: ReadingUnit,
    nominal: Option<Matrix3<f64>>,
) -> Option<Start> {
    let with = |matrix: Matrix3<f64>| {
        let mut imu = state.imu;
        imu.gyroscope.matrix = matrix;
        imu
    };
    let look = FirstLook::of(joint, state);
    let judged = |matrix: Matrix3<f64>| Some((look.judge(&matrix)?, matrix));
    let best = |tries: &[Matrix3<f64>]| {
        tries
            .par_iter()
            .filter_map(|matrix| judged(*matrix))
            .min_by(|(one, _), (other, _)| one.median_rad.total_cmp(&other.median_rad))
    };
    // the axis about which the fewer rotations turned may be the one that points the other way
    let fewer_upside_down = |matrix: &Matrix3<f64>, before: usize| {
        if before < SEVERAL {
            return None;
        }
        orders()
            .par_iter()
            .filter_map(|order| judged(order * matrix))
            .filter(|(look, _)| SEVERAL * look.upside_down <= before && look.median_rad <= WRONG)
            .min_by(|(one, _), (other, _)| {
                one.upside_down.cmp(&other.upside_down).then(one.median_rad.total_cmp(&other.median_rad))
            })
            .map(|(look, matrix)| Start {
                imu: with(matrix),
                median_rad: look.median_rad,
                axes: Some(Axes::InOrder(names(&matrix))),
            })
    };
    let turned = |gains: &[Matrix3<f64>], is_scaled: bool| {
        let (median_rad, matrix) = tilted::find(&look, gains, is_scaled)?;
        (median_rad <= WRONG).then(|| Start { imu: with(matrix), median_rad, axes: Some(Axes::Turned) })
    };
    if let Some(matrix) = nominal {
        let imu = with(matrix);
        let Judged { median_rad, upside_down } = look.judge(&matrix)?;
        let as_it_is = Start { imu, median_rad, axes: None };
        // few rotations fit some order by chance
        let few = joint.rotations.iter().filter(|data| data.used).count() < ENOUGH;
        if median_rad <= WRONG || (unit != ReadingUnit::Counts && few) {
            return Some(fewer_upside_down(&matrix, upside_down).filter(|_| !few).unwrap_or(as_it_is));
        }
        if unit != ReadingUnit::Counts {
            let (Judged { median_rad, .. }, found) = best(&orders().map(|order| order * matrix))?;
            if median_rad <= WRONG {
                return Some(Start {
                    imu: with(found),
                    median_rad,
                    axes: Some(Axes::InOrder(names(&found))),
                });
            }
            return Some(turned(&[matrix], false).unwrap_or(as_it_is));
        }
    }
    let largest = gain_bound(joint, state)?;
    let gains: Vec<f64> = (0..GAINS).map(|k| 1.1 * largest * FACTOR.powi(k as i32)).collect();
    let scaled = |orders: &[Matrix3<f64>]| -> Vec<Matrix3<f64>> {
        orders.iter().flat_map(|order| gains.iter().map(move |gain| order * *gain)).collect()
    };
    let (mut found, mut matrix) = best(&scaled(&[Matrix3::identity()]))?;
    let mut axes = None;
    if found.median_rad > WRONG {
        let better = best(&scaled(&orders())).filter(|(other, _)| other.median_rad < 0.5 * found.median_rad);
        if let Some(other) = better {
            (found, matrix) = other;
            axes = Some(Axes::InOrder(names(&matrix)));
        }
    }
    if found.median_rad > WRONG {
        let some: Vec<Matrix3<f64>> = gains
            .iter()
            .step_by(2)
            .take(GAINS / 3)
            .map(|gain| Matrix3::from_diagonal_element(*gain))
            .collect();
        if let Some(turned) = turned(&some, true) {
            return Some(turned);
        }
    }
    let Judged { median_rad, upside_down } = found;
    let upright = if median_rad <= WRONG { fewer_upside_down(&matrix, upside_down) } else { None };
    Some(upright.unwrap_or_else(|| Start { imu: with(matrix), median_rad, axes }))
}

/// How far gravity misses after the rotations, for one matrix of the gyroscope.
pub(super) struct Judged {
    /// Median of the angles, rad.
    pub(super) median_rad: f64,
    /// How many are beyond a right angle.
    upside_down: usize,
}

/// The rotations cut down.
pub(super) struct FirstLook {
    rotations: Vec<CutDown>,
}

/// A rotation cut down, with gravity before and after it.
struct CutDown {
    turns: Vec<Vector3<f64>>,
    from: Vector3<f64>,
    to: Vector3<f64>,
}

impl FirstLook {
    /// At a state whose bias counts, whatever its gains.
    pub(super) fn of(joint: &Joint<'_>, state: &State) -> Self {
        let used = joint.rotations.iter().filter(|data| data.used);
        let cut_down = |data: &RotationData<'_>| {
            let step = data.samples.times_s.len().div_ceil(SAMPLES);
            let bias = state.imu.at(data.samples.temperature_c()).gyroscope.bias;
            CutDown {
                turns: data.samples.cut_down(&bias, step),
                from: state.forces[data.from],
                to: state.forces[data.from + 1],
            }
        };
        Self { rotations: used.map(cut_down).collect() }
    }

    /// Number of rotations.
    pub(super) fn len(&self) -> usize {
        self.rotations.len()
    }

    /// Looks at a matrix of the gyroscope; `None` where it is singular, or there are no rotations.
    pub(super) fn judge(&self, matrix: &Matrix3<f64>) -> Option<Judged> {
        let correction = matrix.try_inverse()?;
        let error = |rotation: &CutDown| {
            carried_back(&rotation.turns, &correction, &rotation.from).angle(&rotation.to)
        };
        let errors: Vec<f64> = self.rotations.iter().map(error).collect();
        let upside_down = errors.iter().filter(|error| **error > FRAC_PI_2).count();
        (!errors.is_empty()).then(|| Judged { median_rad: median(errors), upside_down })
    }
}

/// The largest gain that no rotation contradicts, a few outliers apart.
fn gain_bound(joint: &Joint<'_>, state: &State) -> Option<f64> {
    let mut bounds: Vec<f64> = joint
        .rotations
        .iter()
        .filter(|data| data.used)
        .filter_map(|data| {
            let angle = state.forces[data.from].angle(&state.forces[data.from + 1]);
            let samples = &data.samples;
            let bias = state.imu.at(samples.temperature_c()).gyroscope.bias;
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

/// All orders and signs of three axes.
pub(super) fn orders() -> [Matrix3<f64>; 48] {
    let permutations = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    std::array::from_fn(|k| {
        let (permutation, signs) = (permutations[k / 8], k % 8);
        Matrix3::from_fn(|row, column| {
            let sign = if signs >> row & 1 == 0 { 1.0 } else { -1.0 };
            if permutation[row] == column { sign } else { 0.0 }
        })
    })
}

/// The gyroscope's axis along each of the accelerometer's.
pub(super) fn names(matrix: &Matrix3<f64>) -> [String; 3] {
    std::array::from_fn(|column| {
        let row = matrix.column(column).iamax();
        let sign = if matrix[(row, column)] < 0.0 { "-" } else { "" };
        format!("{sign}{}", Axis::ALL[row])
    })
}

/// The means of the gyroscope's readings over the holds, as they would be at the reference temperature, averaged: its bias where nothing turns.
pub(super) fn mean_bias(holds: &[HoldData], thermal: &Thermal) -> Vector3<f64> {
    let (mut sum, mut weights) = (Vector3::zeros(), Vector3::zeros());
    for hold in holds {
        let Some((mean, weight)) = &hold.gyroscope else { continue };
        let change = thermal.gyroscope.bias_change(thermal.tau_k(hold.temperature_c));
        sum += (mean - change).component_mul(weight);
        weights += weight;
    }
    sum.component_div(&weights.map(|weight| weight.max(f64::MIN_POSITIVE)))
}
