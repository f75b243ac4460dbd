//! The shuttle at the limits: the motion that an engineer would write, with which a design is compared.
//!
//! The arm runs to and fro. Its acceleration is a trapezoid: ramps of r intervals, at full acceleration for h intervals, then braking,
//! which goes on as acceleration the other way. The arm is at rest at each turning point, and the first and the last run are half a turn
//! shorter:
//!
//! `0 ↗ +1 (r), h, ↘ −1 (2r), 2h + r, ↗ +1 (2r), 2h + r, … h, → 0 (r)`, with `4r + 2h + (k − 1)(3r + 2h)` intervals for k runs.
//!
//! The amplitude is the largest that the limits admit. Of all r and h, those are taken whose recording determines the parameters best, so
//! that it is a good shuttle with which a design is compared. The axes of a sensor of which each has parameters of its own move together.
//! Where cross-axis sensitivities are sought, one axis moves after the other.

use crate::limits::worst_violation;
use crate::{DesignProblem, Evaluation, evaluate, limit_use};
use calibrant_core::error::Result;
use calibrant_core::motion::{JerkControlledMotion, Limits};
use calibrant_core::sensor::SensorModel;
use nalgebra::Vector3;

/// What an engineer would command: of each axis the best shuttle at its limits. Axes that would move together do so differently, so that swapped ones are
/// noticed: the second one begins the other way, the third one has the next best shuttle. `None` where the intervals are too few, the limits want another
/// beginning or end, or such shuttles determine too little.
///
/// # Errors
/// As [`evaluate`].
pub fn usual_motion(problem: &DesignProblem<'_>) -> Result<Option<JerkControlledMotion>> {
    let mut found = shuttles(problem, &problem.effective_limits())?;
    found.sort_by(|one, other| one.value.total_cmp(&other.value));
    let Some(best) = found.first() else { return Ok(None) };
    if problem.sensor.model == SensorModel::Full || problem.sensor.axes == 1 {
        return Ok(best.covariance.is_some().then(|| best.motion.clone()));
    }
    let first = best.motion.acceleration_mps2();
    let is_other = |motion: &&Evaluation| motion.motion.acceleration_mps2() != first;
    let Some(next) = found.iter().find(is_other) else { return Ok(None) };
    let next = next.motion.acceleration_mps2();
    let nodes = first.iter().zip(next).map(|(a, b)| Vector3::new(a.x, -a.y, b.z)).collect();
    let mixed = evaluate(problem, &JerkControlledMotion::uniform(problem.interval_s, nodes)?)?;
    Ok(mixed.covariance.is_some().then_some(mixed.motion))
}

/// The best shuttle at the limits. `None` where the intervals are too few for one, or the limits want another beginning or end.
///
/// # Errors
/// As [`evaluate`].
pub(super) fn best_shuttle(problem: &DesignProblem<'_>, limits: &Limits) -> Result<Option<Evaluation>> {
    // the first of equals
    let better = |best: Evaluation, found: Evaluation| if found.value < best.value { found } else { best };
    Ok(shuttles(problem, limits)?.into_iter().reduce(better))
}

/// Shuttles of many ramps and holds.
fn shuttles(problem: &DesignProblem<'_>, limits: &Limits) -> Result<Vec<Evaluation>> {
    let mut found = Vec::new();
    for ramp in lengths(1, problem.intervals / 4) {
        for hold in lengths(0, problem.intervals / 2) {
            if let Some(motion) = shuttle(problem, limits, ramp, hold)? {
                found.push(evaluate(problem, &motion)?);
            }
        }
    }
    Ok(found)
}

/// Numbers from `least` to `most`: all of the small ones, and some of the large.
fn lengths(least: usize, most: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(least), |length| Some(length + 1 + length / 4))
        .take_while(move |length| *length <= most)
}

/// The shuttle with ramps and holds of these intervals.
fn shuttle(
    problem: &DesignProblem<'_>,
    limits: &Limits,
    ramp: usize,
    hold: usize,
) -> Result<Option<JerkControlledMotion>> {
    let (n, axes) = (problem.intervals, problem.sensor.axes);
    let turns = if problem.sensor.model == SensorModel::Full { axes } else { 1 };
    let Some(shape) = shape(n / turns, ramp, hold) else { return Ok(None) };
    let mut nodes = vec![Vector3::zeros(); n + 1];
    for axis in 0..axes {
        let begin = if turns > 1 { axis * (n / turns) } else { 0 };
        shape.iter().zip(&mut nodes[begin..]).for_each(|(value, node)| node[axis] = *value);
    }
    let unit = JerkControlledMotion::uniform(problem.interval_s, nodes.clone())?;
    let uses = limit_use(limits, axes, &unit);
    for axis in 0..axes {
        let of_axis = uses.iter().filter(|found| found.axis.index() == axis && found.limit > 0.0);
        let most = of_axis.map(|found| found.value.abs() / found.limit).fold(0.0, f64::max);
        if most == 0.0 {
            return Ok(None);
        }
        nodes.iter_mut().for_each(|node| node[axis] /= most);
        let of_axis: Vec<f64> = nodes.iter().map(|node| node[axis]).collect();
        if worst_violation(&limits.axis(axis), unit.times_s(), &of_axis) > 1e-9 {
            return Ok(None);
        }
    }
    JerkControlledMotion::uniform(problem.interval_s, nodes).map(Some)
}

/// Accelerations at the nodes of as many runs as n intervals have room for, of amplitude 1; zeros after the last.
fn shape(n: usize, ramp: usize, hold: usize) -> Option<Vec<f64>> {
    let (one, more) = (4 * ramp + 2 * hold, 3 * ramp + 2 * hold);
    let runs = 1 + n.checked_sub(one)? / more;
    let mut nodes = vec![0.0];
    let mut go = |to: f64, intervals: usize| {
        let from = nodes.last().copied().unwrap_or(0.0);
        nodes.extend((1..=intervals).map(|k| from + (to - from) * k as f64 / intervals as f64));
    };
    let mut sign = 1.0;
    go(sign, ramp);
    go(sign, hold);
    for run in 1..=runs {
        sign = -sign;
        go(sign, 2 * ramp);
        go(sign, if run == runs { hold } else { 2 * hold + ramp });
    }
    go(0.0, ramp);
    nodes.resize(n + 1, 0.0);
    Some(nodes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::motion::{KnownEnds, Rest, Trust};
    use calibrant_core::sensor::Sensor;

    /// Of one run within 2 m/s² and 20 m/s³, with ramps of 0.1 s and holds of 0.4 s: velocity 1 m/s, and 0.6 m of way, by hand.
    #[test]
    fn a_shuttle_is_at_its_limits_and_at_rest_at_both_ends() {
        let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
        let all = |limit: f64| Some(Vector3::repeat(limit));
        let limits = Limits {
            acceleration_mps2: all(2.0),
            jerk_mps3: all(20.0),
            velocity_mps: all(1.0),
            displacement_m: all(0.6),
            rest: Rest::Both,
            ..Limits::default()
        };
        let problem = DesignProblem {
            intervals: 12,
            interval_s: 0.1,
            ..DesignProblem::new(&sensor, &limits, 1.0).expect("nominal")
        };
        let motion = shuttle(&problem, &limits, 1, 4).expect("valid").expect("room");
        let uses = limit_use(&limits, 1, &motion);
        for kind in ["acceleration", "jerk", "velocity", "displacement"] {
            let found = uses.iter().find(|found| found.kind.name() == kind).expect("limited");
            assert!((found.value.abs() / found.limit - 1.0).abs() < 1e-9, "{found:?}");
        }
        assert!(uses.iter().all(|found| found.violation < 1e-9), "{uses:?}");
        // two runs end where they began
        let (mut v, mut d) = (0.0, 0.0);
        for pair in shape(26, 1, 4).expect("room").windows(2) {
            d += v + pair[0] / 3.0 + pair[1] / 6.0;
            v += (pair[0] + pair[1]) / 2.0;
        }
        assert!(v.abs() < 1e-12 && d.abs() < 1e-12, "{v} {d}");
    }

    /// Readings of swapped or reversed axes then contradict the motion.
    #[test]
    fn axes_that_move_together_move_differently() {
        let sensor = Sensor::memsic_mxd2020u();
        let limits = Limits {
            acceleration_mps2: Some(Vector3::repeat(20.0)),
            jerk_mps3: Some(Vector3::repeat(20.0)),
            ..Limits::default()
        };
        let problem = DesignProblem::new(&sensor, &limits, 10.0).expect("nominal");
        let motion = usual_motion(&problem).expect("valid").expect("room");
        let nodes = motion.acceleration_mps2();
        for (one, other) in [(0, 1), (0, 2), (1, 2)] {
            let largest = nodes.iter().map(|a| (a[one] - a[other]).abs()).fold(0.0, f64::max);
            // thousands of times the noise
            assert!(largest > 1.0, "{one} {other}: {largest}");
        }
        assert!(limit_use(&limits, 3, &motion).iter().all(|found| found.violation < 1e-9));
    }

    /// It begins and ends at acceleration 0. Where only these ends are known, the readings tell the bias, and nothing of the scale factor.
    #[test]
    fn a_shuttle_of_which_only_the_ends_are_known_leaves_scale_factors_undetermined() {
        let sensor = Sensor::memsic_mxd2020u();
        let limits = Limits { acceleration_mps2: Some(Vector3::repeat(30.0)), ..Limits::default() };
        for duration_s in [1.0, 20.0, 300.0] {
            let problem = DesignProblem {
                trust: Trust::Unknown,
                known_ends: KnownEnds::Both,
                ..DesignProblem::new(&sensor, &limits, duration_s).expect("nominal")
            };
            for found in shuttles(&problem, &limits).expect("valid") {
                let parameters: Vec<_> =
                    found.undetermined.iter().flat_map(|group| &group.parameters).collect();
                assert_eq!(parameters, ["scale.x", "scale.y", "scale.z"]);
            }
        }
    }

    /// On three axes with cross-axis sensitivities one axis moves at a time, which determines all of them.
    #[test]
    fn a_shuttle_determines_a_full_sensor() {
        let sensor = Sensor { model: SensorModel::Full, ..Sensor::memsic_mxd2020u() };
        let limits = Limits {
            acceleration_mps2: Some(Vector3::repeat(2.0)),
            jerk_mps3: Some(Vector3::repeat(20.0)),
            ..Limits::default()
        };
        let problem = DesignProblem::new(&sensor, &limits, 10.0).expect("nominal");
        let found = best_shuttle(&problem, &limits).expect("valid").expect("room");
        assert!(found.covariance.is_some());
        let moving = |a: &Vector3<f64>| a.iter().filter(|a| **a != 0.0).count();
        assert!(found.motion.acceleration_mps2().iter().all(|a| moving(a) <= 1));
    }
}
