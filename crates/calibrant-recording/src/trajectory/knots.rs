//! The cubic spline through what a trajectory states at its knots.
//!
//! On uniform knots of distance `h` the control points `c` of a cubic spline give at knot `k`
//!
//! ```text
//! q = (c₋ + 4c + c₊)/6        q̇ = (c₊ − c₋)/2h        q̈ = (c₋ − 2c + c₊)/h²
//! ```
//!
//! So `c = q − h² q̈/6`, and the two outermost ones follow from the velocities at the ends. Positions and velocities alone give the accelerations by Hermite's
//! interpolation. What the control points give must be what the rows say: otherwise the rows are those of another curve, or of a log.

use calibrant_machine::log::JointLog;
use calibrant_machine::spline::{Degree, UniformKnots, VectorSpline};

/// Largest difference of a position from the spline, rad or m: a file may have been rounded to six decimals. Those of the derivatives follow by `1/h` and `6/h²`.
const ROUNDED: f64 = 2e-6;
/// Largest deviation of a knot from even times, in parts of the distance.
const UNEVEN: f64 = 1e-5;
/// Distance of the samples of a log of a trajectory, s, about.
const SAMPLE_S: f64 = 0.01;

/// The spline through rows of positions, velocities and accelerations of joints. `None` where they are not of one cubic spline on knots at these times.
pub(crate) fn spline_through(times_s: &[f64], rows: &[f64], joints: usize) -> Option<VectorSpline> {
    let knots = even_knots(times_s)?;
    let (h, last) = (knots.step_s, knots.intervals);
    let value = |row: usize, derivative: usize, joint: usize| rows[(3 * row + derivative) * joints + joint];
    if joints == 0 || rows.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let mut controls = vec![0.0; knots.controls() * joints];
    for joint in 0..joints {
        let mut at = |i: usize, control: f64| controls[i * joints + joint] = control;
        let inner = |row: usize| value(row, 0, joint) - h * h * value(row, 2, joint) / 6.0;
        (0..=last).for_each(|row| at(row + 1, inner(row)));
        at(0, inner(1) - 2.0 * h * value(0, 1, joint));
        at(last + 2, inner(last - 1) + 2.0 * h * value(last, 1, joint));
    }
    let spline = VectorSpline { knots, dimension: joints, controls };
    let is_on = |row: usize| {
        let weights = knots.weights(knots.knot_s(row));
        (0..3).all(|derivative| {
            let largest = [ROUNDED, ROUNDED / h, 6.0 * ROUNDED / (h * h)][derivative];
            (0..joints).all(|joint| {
                let difference =
                    spline.component(&weights, derivative, joint) - value(row, derivative, joint);
                difference.abs() <= largest
            })
        })
    };
    (0..=last).all(is_on).then_some(spline)
}

/// The same through positions and velocities.
pub(crate) fn spline_through_velocities(
    times_s: &[f64],
    positions: &[f64],
    velocities: &[f64],
    joints: usize,
) -> Option<VectorSpline> {
    let h = even_knots(times_s)?.step_s;
    let rows = times_s.len();
    let mut all = Vec::with_capacity(3 * positions.len());
    for row in 0..rows {
        let at = |of: &[f64], row: usize, joint: usize| of[row * joints + joint];
        // from the interval behind the knot, at the end from the one before
        let (from, sign) = if row + 1 < rows { (row + 1, 1.0) } else { (row - 1, -1.0) };
        all.extend_from_slice(&positions[row * joints..][..joints]);
        all.extend_from_slice(&velocities[row * joints..][..joints]);
        all.extend((0..joints).map(|joint| {
            let rise = at(positions, from, joint) - at(positions, row, joint);
            let speeds = 4.0 * at(velocities, row, joint) + 2.0 * at(velocities, from, joint);
            6.0 * rise / (h * h) - sign * speeds / h
        }));
    }
    spline_through(times_s, &all, joints)
}

fn even_knots(times_s: &[f64]) -> Option<UniformKnots> {
    let (start_s, end_s) = (*times_s.first()?, *times_s.last()?);
    let intervals = times_s.len() - 1;
    let step_s = (end_s - start_s) / intervals as f64;
    let knots = UniformKnots { start_s, step_s, intervals, degree: Degree::Cubic };
    let is_even = |(k, t): (usize, &f64)| (t - knots.knot_s(k)).abs() <= UNEVEN * step_s;
    (intervals > 0 && step_s > 0.0 && times_s.iter().enumerate().all(is_even)).then_some(knots)
}

/// Positions at and between the knots: a log from which the same spline is found again.
pub(crate) fn between_knots(spline: &VectorSpline, names: Vec<String>) -> JointLog {
    let knots = &spline.knots;
    let per_interval = ((knots.step_s / SAMPLE_S).ceil() as usize).clamp(5, 100);
    let samples = knots.intervals * per_interval;
    let time_s = |k: usize| knots.start_s + knots.step_s * (k as f64 / per_interval as f64);
    let times_s: Vec<f64> = (0..=samples).map(time_s).collect();
    let positions = times_s.iter().flat_map(|t| spline.at(*t, 0)).collect();
    JointLog { names, times_s, positions, velocities: None }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A trajectory of two joints without a pattern, from rest to rest.
    pub(in super::super) fn wild() -> VectorSpline {
        let knots = UniformKnots { start_s: 0.0, step_s: 0.2, intervals: 25, degree: Degree::Cubic };
        let of = |i: usize, joint: usize| (1.7 * i.clamp(2, 25) as f64 + joint as f64).sin();
        let controls = (0..28).flat_map(|i| [of(i, 0), of(i, 1)]).collect();
        VectorSpline { knots, dimension: 2, controls }
    }

    fn rows(spline: &VectorSpline, times_s: &[f64]) -> Vec<f64> {
        times_s.iter().flat_map(|t| (0..3).flat_map(|derivative| spline.at(*t, derivative))).collect()
    }

    #[test]
    fn a_spline_is_found_again_from_its_knots_and_from_finer_ones() {
        let spline = wild();
        for parts in [1, 4] {
            let times_s: Vec<f64> = (0..=25 * parts).map(|k| 0.2 / parts as f64 * k as f64).collect();
            let found = spline_through(&times_s, &rows(&spline, &times_s), 2).expect("a spline");
            for t in [0.0, 0.03, 1.117, 4.99] {
                for derivative in 0..3 {
                    let (found, wanted) = (found.at(t, derivative), spline.at(t, derivative));
                    assert!((found[0] - wanted[0]).abs().max((found[1] - wanted[1]).abs()) < 1e-10, "{t}");
                }
            }
        }
    }

    #[test]
    fn velocities_are_enough_and_another_curve_is_none() {
        let spline = wild();
        let times_s: Vec<f64> = (0..=25).map(|k| 0.2 * f64::from(k)).collect();
        let at = |derivative| times_s.iter().flat_map(|t| spline.at(*t, derivative)).collect::<Vec<f64>>();
        let found = spline_through_velocities(&times_s, &at(0), &at(1), 2).expect("a spline");
        assert!(found.controls.iter().zip(&spline.controls).all(|(a, b)| (a - b).abs() < 1e-10));
        let mut bent = rows(&spline, &times_s);
        bent[6 * 7] += 1e-4;
        assert!(spline_through(&times_s, &bent, 2).is_none());
        let mut late = times_s.clone();
        late[7] += 0.01;
        assert!(spline_through(&late, &rows(&spline, &late), 2).is_none());
    }
}
