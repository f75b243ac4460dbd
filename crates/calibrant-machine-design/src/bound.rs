//! How far a trajectory may be from the optimum: no motion within the limits determines the parameters better.
//!
//! # Formula
//! With all nuisances known but the mounting, the information of a row is the moment matrix of `(1, f)` or `(1, w)`. The covariance is at least
//! `D(M)⁻¹ + T σ² Tᵀ`, with the turns `T` that the mounting gives both matrices. A criterion is convex in the moments and does not change with the sensor's axes, so moments with
//! zero mean and equal axes are best, as far as the machine can have them. What it can have:
//!
//! - A joint with range `R`, speed `V` and acceleration `A` that goes from rest to rest has `E q̇² ≤ η V²`, `η = (R − V²/3A)/(R + V²/A)` (strokes over the whole range at full speed), or
//!   `R A/3V²` where the range is too short for full speed. `E q̇⁴` has `(R − 3V²/5A)/(R + V²/A)` likewise.
//! - `E|w|² ≤ Σ c_ij √(E q̇_i² E q̇_j²)` with the largest `c_ij = |z_i·z_j|` of any posture.
//! - The last axis that turns is fixed in the sensor: across it the last joint adds nothing.
//! - `E|f|² = g² + E|p̈|²`, since a motion from rest to rest has the mean acceleration 0. A link of length `r` in a frame with rate `ω` has `|p̈| ≤ r (ω² + √(ω⁴ + 4ω̇²))/2`, the norm of
//!   `[ω̇]× + [ω]×²`; rms values add up at most (Minkowski).
//! - No reading exceeds the sensor's range.
//!
//! The bound is loose: all joints cannot be at their best at once, and the nuisances are not known. Its minimum over the two numbers that share the moments out is
//! looked for on grids that become finer, and is not proved.

use crate::TrajectoryProblem;
use crate::information::{ENTRIES, Sensing, entry};
use calibrant_machine::estimate::MountingPrior;
use nalgebra::{DMatrix, Matrix3, Vector3};

/// Bound of the criterion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryBound {
    /// The smallest value of the criterion that the bound leaves, in nats.
    pub value: f64,
    /// How many times smaller the standard deviations of the optimum may be than those of the design, as their geometric mean (D) or root mean square.
    pub times_better: f64,
}

/// Mean powers of the speed of a joint.
#[derive(Debug, Clone, Copy)]
struct Speeds {
    /// Root of the mean square, and fourth root of the mean fourth power.
    second: f64,
    fourth: f64,
    acceleration: f64,
    /// Largest distance of a joint that slides from its zero.
    largest: f64,
}

fn speeds(limit: &crate::JointLimit) -> Speeds {
    let (range, v, a) = (limit.upper - limit.lower, limit.velocity, limit.acceleration);
    let way = v * v / a;
    let (second, fourth) = if range >= way && way.is_finite() {
        let part = |lost: f64| ((range - lost * way).max(0.0) / (range + way)).min(1.0);
        (v * part(1.0 / 3.0).sqrt(), v * part(0.6).powf(0.25))
    } else {
        let peak = (range * a).sqrt().min(v);
        (peak * (1.0_f64 / 3.0).sqrt(), peak * 0.2_f64.powf(0.25))
    };
    let largest = limit.lower.abs().max(limit.upper.abs());
    if range.is_finite() {
        Speeds { second, fourth, acceleration: a, largest }
    } else {
        Speeds { second: v, fourth: v, acceleration: a, largest }
    }
}

/// Largest `|z_i·z_j|` of the axes in any posture.
fn cosines(problem: &TrajectoryProblem<'_>) -> DMatrix<f64> {
    let joints = &problem.chain.joints;
    let n = joints.len();
    let mut cosines = DMatrix::identity(n, n);
    for i in 0..n {
        // the range of angles between axis i and the axis of the joint behind
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        let mut rotation = nalgebra::UnitQuaternion::identity();
        let mut last = i;
        for j in i + 1..n {
            // joints that slide keep the axes' directions
            rotation *= joints[j].origin.rotation;
            let along = joints[last].axis.dot(&(rotation * joints[j].axis.into_inner()));
            let twist = along.clamp(-1.0, 1.0).acos();
            if joints[last].kind.turns() && joints[j].kind.turns() {
                let fold = |x: f64| (x + twist).min(std::f64::consts::TAU - x - twist);
                let lower = if low <= twist && twist <= high {
                    0.0
                } else {
                    (low - twist).abs().min((high - twist).abs())
                };
                let opposite = std::f64::consts::PI - twist;
                let upper = if low <= opposite && opposite <= high {
                    std::f64::consts::PI
                } else {
                    fold(low).max(fold(high))
                };
                (low, high) = (lower, upper);
                let most = if low <= 0.0 || high >= std::f64::consts::PI {
                    1.0
                } else {
                    low.cos().abs().max(high.cos().abs())
                };
                (cosines[(i, j)], cosines[(j, i)]) = (most, most);
                rotation = nalgebra::UnitQuaternion::identity();
                last = j;
            }
        }
        if !joints[i].kind.turns() {
            for j in 0..n {
                (cosines[(i, j)], cosines[(j, i)]) = (0.0, 0.0);
            }
        }
    }
    cosines
}

/// `E|f|²` at most, `E|w|²` without the last joint that turns, its root mean square speed, and its axis in the sensor.
struct Moments {
    force: f64,
    rate_before: f64,
    last_speed: f64,
    last_axis: Vector3<f64>,
}

fn moments(problem: &TrajectoryProblem<'_>, sensing: &Sensing) -> Moments {
    let joints = &problem.chain.joints;
    let n = joints.len();
    let of: Vec<Speeds> = problem.joints.iter().map(speeds).collect();
    let cosines = cosines(problem);
    let square = |upto: usize, speed: &dyn Fn(usize) -> f64| -> f64 {
        (0..upto)
            .flat_map(|i| (0..upto).map(move |j| (i, j)))
            .map(|(i, j)| cosines[(i, j)] * speed(i) * speed(j))
            .sum()
    };
    let last = (0..n).rev().find(|j| joints[*j].kind.turns());
    let second = |j: usize| of[j].second;
    let fourth = |j: usize| of[j].fourth;
    // rms acceleration of the sensor
    let (mut angular, mut acceleration) = (0.0, 0.0);
    for j in 0..=n {
        let squared = square(j, &fourth);
        let bend = |length: f64, angular: f64| {
            length * (squared + (squared * squared + 4.0 * angular * angular).sqrt()) / 2.0
        };
        let arm: Vector3<f64> = match joints.get(j) {
            Some(joint) => joint.origin.translation.vector,
            None => Vector3::from(sensing.links.fixed[n].rho.0),
        };
        acceleration += bend(arm.norm(), angular);
        if let (Some(joint), Some(of)) = (joints.get(j), of.get(j)) {
            if joint.kind.turns() {
                angular += squared.sqrt() * of.fourth + of.acceleration;
            } else {
                acceleration +=
                    bend(of.largest, angular) + 2.0 * squared.sqrt() * of.fourth + of.acceleration;
            }
        }
    }
    let tip = |j: usize| {
        joints[j + 1..]
            .iter()
            .fold(nalgebra::UnitQuaternion::identity(), |turn, joint| turn * joint.origin.rotation)
            * problem.chain.tip_transform.rotation
            * problem.setup.tip_from_sensor
    };
    Moments {
        force: problem.setup.gravity_mps2.powi(2) + acceleration * acceleration,
        rate_before: last.map_or(0.0, |last| square(last, &second)),
        last_speed: last.map_or(0.0, |last| of[last].second),
        last_axis: last.map_or(Vector3::z(), |last| tip(last).inverse() * joints[last].axis.into_inner()),
    }
}

/// The bound; `None` where the sensor has not both full matrices, or the best moments determine nothing.
pub(crate) fn bound(
    problem: &TrajectoryProblem<'_>,
    sensing: &Sensing,
    value: f64,
) -> Option<TrajectoryBound> {
    if sensing.columns.len() != ENTRIES {
        return None;
    }
    let moments = moments(problem, sensing);
    let largest = |range: &Vector3<f64>| range.map(|range| range * range);
    let (f, w) = (largest(&problem.force_range_mps2), largest(&problem.rate_range_radps));
    let force = moments.force.min(f.sum());
    let prior = match problem.setup.mounting {
        MountingPrior::Exact => 0.0,
        MountingPrior::Within(sd) => sd * sd,
        MountingPrior::Unknown => return None,
    };
    // axes whose third is the last joint's
    let axis = moments.last_axis.normalize();
    let first = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
    let axes = Matrix3::from_columns(&[first, axis.cross(&first), axis]);
    let at = |along: f64, before: f64| {
        let rate =
            [(moments.rate_before - before * before).max(1e-9) / 2.0, (moments.last_speed + before).powi(2)];
        let cap = |moment: f64, range: &Vector3<f64>| moment.min(range.max());
        let of_force =
            Vector3::new((1.0 - along) / 2.0, (1.0 - along) / 2.0, along).map(|part| cap(part * force, &f));
        let of_rate = Vector3::new(rate[0], rate[0], rate[1]).map(|moment| cap(moment, &w));
        let covariance = covariance(problem, sensing, &axes, [of_force, of_rate], prior);
        sensing.criterion.of_covariance(&sensing.columns.of_parameters(&covariance))
    };
    let mut best = (f64::INFINITY, 1.0 / 3.0, 0.0);
    let (mut steps, before) = ((0.5, 0.5), moments.rate_before.sqrt());
    // a grid, then finer ones about its best point
    for level in 0..12 {
        let (_, b, x) = best;
        let centre = if level == 0 { (0.5, 0.5) } else { (b, x / before.max(1e-12)) };
        for i in -10..=10 {
            for j in -10..=10 {
                let along = (centre.0 + steps.0 * f64::from(i) / 10.0).clamp(0.01, 0.98);
                let part = (centre.1 + steps.1 * f64::from(j) / 10.0).clamp(0.0, 0.999);
                if let Some(value) = at(along, part * before)
                    && value < best.0
                {
                    best = (value, along, part * before);
                }
            }
        }
        steps = (steps.0 * 0.4, steps.1 * 0.4);
    }
    best.0.is_finite().then(|| TrajectoryBound {
        value: best.0,
        times_better: ((value - best.0) / (2.0 * sensing.criterion.numbers(ENTRIES) as f64)).exp(),
    })
}

/// The covariance of the 24 entries with these second moments in these axes.
fn covariance(
    problem: &TrajectoryProblem<'_>,
    sensing: &Sensing,
    axes: &Matrix3<f64>,
    moments: [Vector3<f64>; 2],
    mounting: f64,
) -> DMatrix<f64> {
    let mut covariance = DMatrix::zeros(ENTRIES, ENTRIES);
    for (s, moment) in moments.iter().enumerate() {
        let noise = 1.0 / (sensing.rates[s] * problem.duration_s);
        let inverse = axes * Matrix3::from_diagonal(&moment.map(|moment| noise / moment)) * axes.transpose();
        for row in 0..3 {
            let first = entry(s, row, 0);
            covariance[(first, first)] = noise;
            covariance.fixed_view_mut::<3, 3>(first + 1, first + 1).copy_from(&inverse);
        }
    }
    for axis in 0..3 {
        // what a turn of the mounting does to the matrices: [e]×
        let cross = Vector3::<f64>::ith(axis, 1.0).cross_matrix();
        let places: Vec<(usize, f64)> = [0, 1]
            .into_iter()
            .flat_map(|s| (0..3).flat_map(move |i| (0..3).map(move |j| (s, i, j))))
            .map(|(s, i, j)| (entry(s, i, 1 + j), cross[(i, j)]))
            .filter(|(_, factor)| *factor != 0.0)
            .collect();
        for (a, x) in &places {
            for (b, y) in &places {
                covariance[(*a, *b)] += mounting * x * y;
            }
        }
    }
    covariance
}
