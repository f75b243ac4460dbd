//! Short gaps in the orientations of a log whose positions go on, bridged by the gyroscope.
//!
//! With noisy trust the sensor determines the motion as well as the log does. Where the log has a gap, both sensors hold the control points there, so no
//! sample is lost. What the iteration begins with must be near, though: a hand turns by radians in a third of a second. The gyroscope's rate, summed over
//! the gap, tells how; the difference that is left at its end is spread over it.

use super::covered;
use super::reference_fit::{gaps, seen_orientations};
use crate::estimate::MachineTrust;
use crate::estimate::least_squares::{Model, State};
use crate::log::{PoseLog, ReferenceLog};
use crate::reference::Motion;
use crate::spline::fit_rotations;
use calibrant_core::sensor::SensorKind;
use nalgebra::{Matrix3, UnitQuaternion};

/// Longest gap that is bridged, s. A sensor that is known to a per cent is off by less than a tenth of a turn after it, from where the iteration
/// converges.
const LONGEST_S: f64 = 1.0;

/// Lets the sensors hold the motion in short gaps of a log of poses.
pub(crate) fn bridge(model: &mut Model<'_>, state: &mut State) {
    let Some(log) = bridged(model) else { return };
    let knots = state.motion.knots();
    let filled = filled(log, model, state);
    if let (Motion::Poses(poses), true) = (&mut state.motion, filled.times_s.len() > log.times_s.len()) {
        poses.orientation = fit_rotations(&filled.times_s, &filled.world_from_body, knots).spline;
    }
    cover(model, state);
}

/// The intervals whose control points log and sensors hold.
pub(crate) fn cover(model: &mut Model<'_>, state: &State) {
    let bridged_s = bridged(model).map_or(0.0, |_| LONGEST_S);
    model.covered = covered(model.log.log, &state.motion.knots(), bridged_s);
}

/// The log whose gaps are bridged: of poses, beside an accelerometer and a gyroscope.
fn bridged<'a>(model: &Model<'a>) -> Option<&'a PoseLog> {
    match model.log.log {
        ReferenceLog::Poses(log) => (model.trust == MachineTrust::Noisy
            && model.streams.len() == SensorKind::ALL.len())
        .then_some(log),
        ReferenceLog::Joints(_) => None,
    }
}

/// The log with the orientations that the gyroscope tells in its gaps.
fn filled(log: &PoseLog, model: &Model<'_>, state: &State) -> PoseLog {
    let mut rows: Vec<(f64, Option<UnitQuaternion<f64>>)> =
        log.times_s.iter().copied().zip(log.world_from_body.iter().copied()).collect();
    for (from_s, to_s) in gaps(&seen_orientations(log), state.motion.knots().step_s) {
        if to_s - from_s <= LONGEST_S {
            let told = told(model, state, (from_s, to_s)).into_iter();
            rows.extend(told.map(|(time_s, orientation)| (time_s, Some(orientation))));
        }
    }
    rows.sort_by(|one, other| one.0.total_cmp(&other.0));
    let (times_s, world_from_body) = rows.into_iter().unzip();
    PoseLog { times_s, positions_m: Vec::new(), world_from_body }
}

/// The orientations between two times, from the gyroscope.
fn told(model: &Model<'_>, state: &State, (from_s, to_s): (f64, f64)) -> Vec<(f64, UnitQuaternion<f64>)> {
    let gyroscope = SensorKind::Gyroscope as usize;
    let (Some(stream), Motion::Poses(poses)) = (model.streams.get(gyroscope), &state.motion) else {
        return Vec::new();
    };
    let sensor = state.parameters.imu.sensor(SensorKind::Gyroscope);
    let inverse = sensor.matrix.try_inverse().unwrap_or_else(Matrix3::identity);
    let mounting = state.parameters.mount.tip_from_sensor;
    let mut at = poses.orientation.at(from_s).world_from_body;
    let (mut before_s, mut told) = (from_s, Vec::new());
    let first = (0..stream.recording.len()).find(|k| model.motion_time(gyroscope, *k, state) > from_s);
    for k in first.unwrap_or(stream.recording.len())..stream.recording.len() {
        let time_s = model.motion_time(gyroscope, k, state).min(to_s);
        let rate = mounting * (inverse * (stream.recording.readings()[k] - sensor.bias));
        at *= UnitQuaternion::from_scaled_axis(rate * (time_s - before_s));
        before_s = time_s;
        told.push((time_s, at));
        if time_s == to_s {
            break;
        }
    }
    let left = (at.inverse() * poses.orientation.at(to_s).world_from_body).scaled_axis();
    for (time_s, orientation) in &mut told {
        *orientation *= UnitQuaternion::from_scaled_axis(left * ((*time_s - from_s) / (to_s - from_s)));
    }
    told.pop();
    told
}
