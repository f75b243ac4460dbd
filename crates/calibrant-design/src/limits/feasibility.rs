//! Feasibility: do the limits admit a motion at all, and if not, which of them clash?
//!
//! Limits are symmetric, so without prescribed ends standing still is admissible, and there is nothing to
//! check. With prescribed ends three clashes are plain. An end is beyond the acceleration limit, or beyond
//! the intercept limit at t = 0. Or the ends are too far apart for the jerk limit. A convex program decides
//! the rest. A deletion filter then names a minimal set of limits that clash: without any one of them there
//! is a motion.

use super::{LimitKind, Region, WatchedIntervals, worst_violation};
use crate::convex::{ConicProgram, Row};
use crate::{DesignProblem, limit_use};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::{AxisLimits, JerkControlledMotion, Limits, Rest};
use calibrant_core::sensor::Axis;
use nalgebra::Vector3;

/// Relative distance from the limits below which there is no room to move.
const ROOM: f64 = 1e-9;

/// Checks that the limits admit a motion.
///
/// # Errors
/// [`Error::Infeasible`] names the axis and the limits that clash.
pub fn check_feasible(problem: &DesignProblem<'_>) -> Result<()> {
    let limits = problem.effective_limits();
    let times: Vec<f64> = (0..=problem.intervals).map(|i| i as f64 * problem.interval_s).collect();
    for &axis in problem.sensor.active_axes() {
        let own = limits.axis(axis.index());
        if own.start.is_none() && own.end.is_none() {
            continue;
        }
        if let Some(input_error) = plain_clash(axis, &own, &times) {
            return Err(Error::infeasible(input_error));
        }
        if interior_motion(&own, &times).is_none() {
            return Err(Error::infeasible(clash(axis, &own, &times)));
        }
    }
    Ok(())
}

/// An admissible motion away from the limits, and its relative distance from all of them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Interior {
    /// Accelerations at the nodes of one axis.
    pub(crate) nodes: Vec<f64>,
    /// The motion keeps every limit with this share of it to spare, at all times. Prescribed values are the
    /// exception.
    pub(crate) slack: f64,
}

/// The admissible motion of one axis that keeps the largest common share of every limit to spare. `None`
/// where the limits admit none, or leave no room.
///
/// Control points (Bézier) bound velocity and displacement, which is safe between the nodes. Where that finds
/// nothing, the bounds are exact.
pub(crate) fn interior_motion(limits: &AxisLimits, times: &[f64]) -> Option<Interior> {
    if limits.start.is_none() && limits.end.is_none() {
        return Some(Interior { nodes: vec![0.0; times.len()], slack: 1.0 });
    }
    let by_control_points = widest(limits, times);
    let mut nodes = by_control_points.or_else(|| any(limits, times))?;
    let region = Region::new(*limits, times);
    (0..2).for_each(|_| region.settle(&mut nodes));
    let slack = spare(limits, times, &nodes);
    (slack > ROOM && worst_violation(limits, times, &nodes) <= 1e-9).then_some(Interior { nodes, slack })
}

/// An admissible motion on all axes away from the limits, and its relative distance from all of them.
///
/// # Errors
/// As [`check_feasible`], with a shorter message.
pub(crate) fn inside(
    limits: &Limits,
    axes: usize,
    intervals: usize,
    interval_s: f64,
) -> Result<(JerkControlledMotion, f64)> {
    let times: Vec<f64> = (0..=intervals).map(|i| i as f64 * interval_s).collect();
    let mut nodes = vec![Vector3::zeros(); times.len()];
    let mut slack = 1.0_f64;
    for &axis in &Axis::ALL[..axes] {
        let own = limits.axis(axis.index());
        let Some(interior) = interior_motion(&own, &times) else {
            let input_error = plain_clash(axis, &own, &times);
            return Err(Error::infeasible(input_error.unwrap_or_else(|| clash(axis, &own, &times))));
        };
        slack = slack.min(interior.slack);
        nodes.iter_mut().zip(interior.nodes).for_each(|(node, value)| node[axis.index()] = value);
    }
    Ok((JerkControlledMotion::uniform(interval_s, nodes)?, slack))
}

/// The motion with the largest common slack. Control points bound velocity and displacement.
fn widest(limits: &AxisLimits, times: &[f64]) -> Option<Vec<f64>> {
    let n = times.len() - 1;
    let size = Region::new(*limits, times).size;
    if !size.is_finite() {
        return None;
    }
    let mut program = ConicProgram::default();
    let nodes = program.add_variables(n + 1);
    let slack = program.add_variables(1);
    let velocity = program.add_variables(n + 1);
    let displacement = program.add_variables(n + 1);
    program.add_linear(slack, -1.0);
    // a bound, as nothing else may bound it
    program.nonnegative(Row::new(1.0, [(slack, -1.0)]));
    let a = |i: usize| Row::new(0.0, [(nodes + i, size)]);
    let dt = times[1] - times[0];
    let (v_size, d_size) =
        (limits.velocity.unwrap_or(size * dt), limits.displacement.unwrap_or(size * dt * dt));
    let v = |i: usize| Row::new(0.0, [(velocity + i, v_size)]);
    let d = |i: usize| Row::new(0.0, [(displacement + i, d_size)]);
    // |row| ≤ limit (1 − slack)
    let keep = |program: &mut ConicProgram, row: &Row, limit: Option<f64>| {
        let Some(limit) = limit else { return };
        for sign in [1.0, -1.0] {
            let room = Row::new(1.0, [(slack, -1.0)]);
            program.nonnegative(room.plus(&row.clone().times(sign / limit)));
        }
    };
    let fixed = |program: &mut ConicProgram, row: Row, value: f64, size: f64| {
        program.zero(row.plus(&Row::new(-value, [])).times(1.0 / size));
    };
    fixed(&mut program, v(0), 0.0, v_size);
    fixed(&mut program, d(0), 0.0, d_size);
    for (i, prescribed) in [(0, limits.start), (n, limits.end)] {
        if let Some(value) = prescribed {
            fixed(&mut program, a(i), value, size);
        } else {
            keep(&mut program, &a(i), limits.acceleration);
        }
    }
    (1..n).for_each(|i| keep(&mut program, &a(i), limits.acceleration));
    for i in 0..n {
        let dt = times[i + 1] - times[i];
        let u = a(i + 1).plus(&a(i).times(-1.0)).times(1.0 / dt);
        keep(&mut program, &u, limits.jerk);
        let through_start = i == 0 && times[0] == 0.0 && limits.start.is_some();
        if !through_start {
            keep(&mut program, &a(i).plus(&u.times(-times[i])), limits.intercept);
        }
        let next = v(i).plus(&a(i).plus(&a(i + 1)).times(dt / 2.0));
        fixed(&mut program, next.plus(&v(i + 1).times(-1.0)), 0.0, v_size);
        let bend = a(i).times(2.0).plus(&a(i + 1)).times(dt * dt / 6.0);
        let next = d(i).plus(&v(i).times(dt)).plus(&bend);
        fixed(&mut program, next.plus(&d(i + 1).times(-1.0)), 0.0, d_size);
        for row in [v(i).plus(&a(i).times(dt / 2.0)), v(i + 1)] {
            keep(&mut program, &row, limits.velocity);
        }
        for row in [d(i).plus(&v(i).times(dt / 3.0)), d(i + 1).plus(&v(i + 1).times(-dt / 3.0)), d(i + 1)] {
            keep(&mut program, &row, limits.displacement);
        }
    }
    if limits.rest == Rest::Both {
        fixed(&mut program, v(n), 0.0, v_size);
    }
    let solution = program.solve()?;
    (solution.x[slack] > ROOM).then(|| (0..=n).map(|i| size * solution.x[nodes + i]).collect())
}

/// Any admissible motion, exactly: the convex program of the region, without an objective.
fn any(limits: &AxisLimits, times: &[f64]) -> Option<Vec<f64>> {
    let mut region = Region::new(*limits, times);
    let n = times.len() - 1;
    if !region.size.is_finite() {
        // nothing but prescribed ends, and rest
        let ends = [limits.start, limits.end].into_iter().flatten();
        region.size = ends.fold(1.0, |size: f64, end| size.max(end.abs()));
    }
    let mut watch = WatchedIntervals::default();
    // watched intervals are few and are found soon
    for _ in 0..=n {
        let mut program = ConicProgram::default();
        let first = program.add_variables(n + 1);
        region.add_to(&mut program, |i| first + i, &watch);
        let solution = program.solve()?;
        let nodes: Vec<f64> = (0..=n).map(|i| region.size * solution.x[first + i]).collect();
        if !region.update_watch(&nodes, &mut watch) {
            let good = worst_violation(limits, times, &nodes) < 1e-6;
            return good.then_some(nodes);
        }
    }
    None
}

/// The smallest share of any limit that a motion has to spare; negative where one is broken. Prescribed
/// values do not count.
fn spare(limits: &AxisLimits, times: &[f64], a: &[f64]) -> f64 {
    let n = times.len() - 1;
    // the peaks of everything but acceleration and intercept are those of the whole motion
    let motion =
        JerkControlledMotion::new(times.to_vec(), a.iter().map(|&a| Vector3::new(a, 0.0, 0.0)).collect());
    let Ok(motion) = motion else { return -1.0 };
    let all = |limit: Option<f64>| limit.map(Vector3::repeat);
    let whole = Limits {
        jerk_mps3: all(limits.jerk),
        velocity_mps: all(limits.velocity),
        displacement_m: all(limits.displacement),
        ..Limits::default()
    };
    let mut least = limit_use(&whole, 1, &motion)
        .iter()
        .map(|found| 1.0 - found.value.abs() / found.limit)
        .fold(1.0, f64::min);
    for (i, node) in a.iter().enumerate() {
        let prescribed = (i == 0 && limits.start.is_some()) || (i == n && limits.end.is_some());
        if let (false, Some(limit)) = (prescribed, limits.acceleration) {
            least = least.min(1.0 - node.abs() / limit);
        }
    }
    for (i, x) in motion.intercept_mps2().iter().enumerate() {
        let prescribed = i == 0 && times[0] == 0.0 && limits.start.is_some();
        if let (false, Some(limit)) = (prescribed, limits.intercept) {
            least = least.min(1.0 - x.x.abs() / limit);
        }
    }
    least
}

/// The clashes that need no program.
fn plain_clash(axis: Axis, limits: &AxisLimits, times: &[f64]) -> Option<InputError> {
    let reject = |kind: LimitKind, message: String, help: String| {
        Some(
            InputError::new(Refusal::MotionInfeasible, message, help)
                .about_key(format!("limits.{}", kind.key())),
        )
    };
    let ends = [(LimitKind::StartAcceleration, limits.start), (LimitKind::EndAcceleration, limits.end)];
    for (kind, value) in ends {
        if let (Some(value), Some(limit)) = (value, limits.acceleration)
            && value.abs() > limit
        {
            return reject(
                kind,
                format!(
                    "the limits admit no motion: the {} of axis {axis}, {value} m/s², lies beyond its largest acceleration of {limit} m/s²",
                    kind.name()
                ),
                "bring it within, or raise limits.acceleration_mps2 (and sensor.range_mps2)".into(),
            );
        }
    }
    if let (Some(start), Some(limit)) = (limits.start, limits.intercept)
        && times[0] == 0.0
        && start.abs() > limit
    {
        return reject(
            LimitKind::StartAcceleration,
            format!(
                "the limits admit no motion: the first interval of axis {axis} begins at {start} m/s², which is its intercept, beyond the limit of {limit} m/s²"
            ),
            "bring it within, or raise limits.intercept_mps2".into(),
        );
    }
    if let (Some(start), Some(end), Some(jerk)) = (limits.start, limits.end, limits.jerk) {
        let needed = (end - start).abs() / (times[times.len() - 1] - times[0]);
        if needed > jerk {
            return reject(
                LimitKind::EndAcceleration,
                format!(
                    "the limits admit no motion: to go from {start} to {end} m/s² along axis {axis} takes a jerk of {needed:.4} m/s³, the limit is {jerk} m/s³"
                ),
                "bring the ends closer together, raise limits.jerk_mps3, or take more time".into(),
            );
        }
    }
    None
}

/// A minimal set of limits that clash.
fn clash(axis: Axis, limits: &AxisLimits, times: &[f64]) -> InputError {
    let mut kept = *limits;
    let mut kinds: Vec<LimitKind> = LimitKind::ALL.into_iter().filter(|&kind| has(limits, kind)).collect();
    for kind in kinds.clone() {
        let less = without(&kept, kind);
        // the remaining limits still clash: this one has no part in it
        if any(&less, times).is_none() {
            kept = less;
            kinds.retain(|&other| other != kind);
        }
    }
    let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
    let keys: Vec<String> = kinds.iter().map(|kind| format!("limits.{}", kind.key())).collect();
    let rounded = |time: f64| (time * 1e9).round() / 1e9;
    let (duration, interval) = (rounded(times[times.len() - 1] - times[0]), rounded(times[1] - times[0]));
    let (message, help) = match names.split_last() {
        Some((last, rest)) if !rest.is_empty() && any(limits, times).is_none() => (
            format!(
                "the limits admit no motion of {duration} s in intervals of {interval} s along axis {axis}: its limits on {} and {last} clash, though without any one of them there is a motion",
                rest.join(", ")
            ),
            format!("loosen one of {}, or take more time", keys.join(", ")),
        ),
        _ => (
            format!("the limits leave axis {axis} no room: at best a single motion keeps them all"),
            "loosen the limits a little".into(),
        ),
    };
    InputError::new(Refusal::MotionInfeasible, message, help)
}

fn has(limits: &AxisLimits, kind: LimitKind) -> bool {
    match kind {
        LimitKind::Acceleration => limits.acceleration.is_some(),
        LimitKind::Jerk => limits.jerk.is_some(),
        LimitKind::Intercept => limits.intercept.is_some(),
        LimitKind::Velocity => limits.velocity.is_some(),
        LimitKind::Displacement => limits.displacement.is_some(),
        LimitKind::RestAtEnd => limits.rest == Rest::Both,
        LimitKind::StartAcceleration => limits.start.is_some(),
        LimitKind::EndAcceleration => limits.end.is_some(),
    }
}

fn without(limits: &AxisLimits, kind: LimitKind) -> AxisLimits {
    let mut less = *limits;
    match kind {
        LimitKind::Acceleration => less.acceleration = None,
        LimitKind::Jerk => less.jerk = None,
        LimitKind::Intercept => less.intercept = None,
        LimitKind::Velocity => less.velocity = None,
        LimitKind::Displacement => less.displacement = None,
        LimitKind::RestAtEnd => less.rest = Rest::Start,
        LimitKind::StartAcceleration => less.start = None,
        LimitKind::EndAcceleration => less.end = None,
    }
    less
}

#[cfg(test)]
#[path = "feasibility_tests.rs"]
mod tests;
