//! Which pose to take next: the one that improves the criterion of the design most, and of nearly equal ones the least turn.

use calibrant::design::poses::{Allowed, PoseProblem, covariance_of_holds, shares_of_holds};
use calibrant::io::{Experiment, Plan};
use calibrant_core::estimate::{Calibration, ON_FACE_RAD};
use nalgebra::{DMatrix, Vector3};
use std::collections::BTreeMap;

/// By the names of parameters.
pub(crate) type Ratios = BTreeMap<String, f64>;

/// Poses within this share of the best are as good.
const AS_GOOD: f64 = 0.03;

/// The next pose.
#[derive(Debug, Clone)]
pub(crate) struct NextPose {
    /// Direction of the specific force (up) in the axes of the sensor.
    pub(crate) up: Vector3<f64>,
    /// Standard deviations after it over those now, by the names of parameters; none before there is a calibration.
    pub(crate) after: Ratios,
    /// How much smaller three more holds make the standard deviations, on average; not of known faces, of which each counts once.
    pub(crate) three_gain: Option<f64>,
    /// How much each hold that is used tells, as a share of what all tell, in order of time.
    pub(crate) shares: Vec<f64>,
}

/// The directions that a pose may have: the known ones, of those that were held least often, and by turns that were made least often; where all are allowed, faces, edges and corners, which are
/// easiest to hold and to say.
fn candidates(experiment: &Experiment, held: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    if let Some(faces) = faces(experiment) {
        let times = |face: &Vector3<f64>| held.iter().filter(|up| is_on(face, up)).count();
        // a gyroscope needs turns from each face to each other: there and back is one
        let turns = |face: &Vector3<f64>| match held.last() {
            Some(last) if experiment.imu.is_some() && !is_on(face, last) => {
                let is_it = |pair: &[Vector3<f64>]| {
                    is_on(face, &pair[0]) && pair[1].angle(last) <= ON_FACE_RAD
                        || is_on(face, &pair[1]) && pair[0].angle(last) <= ON_FACE_RAD
                };
                held.windows(2).filter(|pair| is_it(pair)).count()
            }
            Some(_) if experiment.imu.is_some() => usize::MAX,
            _ => 0,
        };
        // first each face once
        let order = |face: &Vector3<f64>| match times(face) {
            0 => (0, 0, 0),
            times => (1, turns(face), times),
        };
        let first = faces.iter().map(order).min();
        return faces.into_iter().filter(|face| Some(order(face)) == first).collect();
    }
    match experiment.design.allowed_directions().unwrap_or(Allowed::Anywhere) {
        Allowed::Of(list) | Allowed::Near(list, _) => list,
        Allowed::Anywhere => match Allowed::cube(true, true) {
            Allowed::Of(list) => list,
            _ => Vec::new(),
        },
    }
}

/// The directions that holds have, where the experiment knows them.
pub(crate) fn faces(experiment: &Experiment) -> Option<Vec<Vector3<f64>>> {
    match &experiment.plan {
        Plan::Holds(holds) => holds.directions(),
        _ => None,
    }
}

/// Is it an accelerometer on faces? Of these, folds tell nothing.
pub(crate) fn is_on_faces_alone(experiment: &Experiment) -> bool {
    experiment.imu.is_none() && faces(experiment).is_some()
}

/// Is a direction on this face?
pub(crate) fn is_on(face: &Vector3<f64>, up: &Vector3<f64>) -> bool {
    face.angle(up) <= ON_FACE_RAD
}

/// Before there is a calibration: the direction that is farthest from those held. `holds`: their number, whether or not it is known which way was up.
pub(crate) fn first_poses(
    experiment: &Experiment,
    holds: usize,
    held: &[Vector3<f64>],
    put_off: &[Vector3<f64>],
) -> Option<NextPose> {
    let nearest = |of: &Vector3<f64>| held.iter().chain(put_off).map(|up| up.dot(of)).fold(-1.0, f64::max);
    let all = candidates(experiment, held);
    let up = if held.is_empty() {
        // which way was up is not known yet: one after the other
        *all.get(holds % all.len().max(1))?
    } else {
        all.into_iter().min_by(|one, other| nearest(one).total_cmp(&nearest(other)))?
    };
    Some(NextPose { up, after: Ratios::new(), three_gain: None, shares: Vec::new() })
}

/// The best next pose of a calibration. `now`: the direction in which the sensor lies; `put_off`: those that were refused; `weakest`: the axis of the gyroscope that is known least.
pub(crate) fn next_pose(
    experiment: &Experiment,
    calibration: &Calibration,
    now: Option<Vector3<f64>>,
    put_off: &[Vector3<f64>],
    weakest: Option<Vector3<f64>>,
) -> Option<NextPose> {
    let (problem, held) = experiment.recorded_poses(calibration).ok()?;
    let all = candidates(experiment, &held);
    let before = covariance_of_holds(&problem, &held)?;
    let cost = |up: &Vector3<f64>| {
        let refused = put_off.iter().any(|of| of.dot(up) > 0.95);
        let turn = now.map_or(0.0, |now| now.angle(up));
        // a turn about the axis that is known least tells of it
        let along = match (now, weakest) {
            (Some(now), Some(weakest)) => now.cross(up).dot(&weakest).abs(),
            _ => 0.0,
        };
        turn / std::f64::consts::PI - along + if refused { 10.0 } else { 0.0 }
    };
    let shares = shares_of_holds(&problem, &held, &before).unwrap_or_default();
    if faces(experiment).is_some() {
        // the rotations between faces tell of a gyroscope, and a face again of nothing
        let is_held = |face: &Vector3<f64>| held.iter().any(|up| is_on(face, up));
        let open = all.iter().filter(|face| experiment.imu.is_some() || !is_held(face));
        let up = *open.min_by(|one, other| cost(one).total_cmp(&cost(other)))?;
        return Some(NextPose { up, after: Ratios::new(), three_gain: None, shares });
    }
    let with = |held: &[Vector3<f64>], up: &Vector3<f64>| {
        let mut poses = held.to_vec();
        poses.push(*up);
        covariance_of_holds(&problem, &poses)
    };
    let scored = all.iter().filter_map(|up| Some((*up, with(&held, up)?)));
    let scored: Vec<_> = scored.map(|(up, after)| (up, problem.criterion.value(&after), after)).collect();
    let best = scored.iter().map(|(_, value, _)| *value).reduce(f64::min)?;
    let gain = problem.criterion.value(&before) - best;
    // where hardly anything is gained, all are as good
    let as_good = |value: f64| value - best <= (AS_GOOD * best.abs()).max(0.1 * gain);
    let chosen = scored.iter().filter(|(_, value, _)| as_good(*value));
    let (up, _, after) = chosen.min_by(|one, other| cost(&one.0).total_cmp(&cost(&other.0)))?;
    let ratios = |after: &DMatrix<f64>| -> Vec<f64> {
        (0..before.nrows()).map(|k| (after[(k, k)] / before[(k, k)]).sqrt()).collect()
    };
    let names = problem.list.names();
    let named = names.into_iter().map(|name| format!("accelerometer.{name}")).zip(ratios(after)).collect();
    Some(NextPose {
        up: *up,
        after: named,
        three_gain: Some(three_gain(&problem, &held, &all, &before)),
        shares,
    })
}

/// How much smaller the standard deviations are with three more holds, on average: each the best by itself.
fn three_gain(
    problem: &PoseProblem,
    held: &[Vector3<f64>],
    all: &[Vector3<f64>],
    before: &DMatrix<f64>,
) -> f64 {
    let mut poses = held.to_vec();
    let mut last = before.clone();
    for _ in 0..3 {
        let tried = all.iter().filter_map(|up| {
            let mut with = poses.clone();
            with.push(*up);
            let covariance = covariance_of_holds(problem, &with)?;
            Some((*up, problem.criterion.value(&covariance), covariance))
        });
        let Some((up, _, covariance)) = tried.min_by(|one, other| one.1.total_cmp(&other.1)) else { break };
        poses.push(up);
        last = covariance;
    }
    let size = before.nrows() as f64;
    1.0 - (0..before.nrows()).map(|k| (last[(k, k)] / before[(k, k)]).sqrt()).sum::<f64>() / size
}
