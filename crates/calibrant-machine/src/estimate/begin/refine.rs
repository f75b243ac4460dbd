//! Knots that are nearer than a log alone could hold.
//!
//! The first knots follow from the log. Where the residuals of the sensors are larger than their noise, the motion has parts that these knots cannot follow, and
//! both sensors, which are read more often than the log, may well hold more control points. So the knots are put half as far apart.

use super::{bridge, fitted};
use crate::estimate::MachineTrust;
use crate::estimate::least_squares::{Model, State};
use crate::log::{JointLog, PoseLog, ReferenceLog};
use crate::reference::Motion;
use crate::spline::UniformKnots;
use calibrant_core::sensor::SensorKind;

/// A spline of this number of samples for each interval is the one that they are of.
const SAMPLES: usize = 4;
/// A control point needs this number of samples, or some are held by nothing.
const HOLDING: f64 = 2.0;

/// Knots that are hardly nearer do not help.
const NEARER: f64 = 0.75;

/// Model and state with knots half as far apart; `None` where nothing would hold so many control points.
pub(crate) fn refined<'a>(model: &Model<'a>, state: &State) -> Option<(Model<'a>, State)> {
    let knots = state.motion.knots();
    let step_s = (0.5 * knots.step_s).max(HOLDING * holding_step_s(model));
    if model.trust == MachineTrust::Known || step_s > NEARER * knots.step_s {
        return None;
    }
    let finer = UniformKnots::covering(knots.start_s, knots.end_s(), step_s, knots.degree);
    let chain = match &state.motion {
        Motion::Joints(joints) => Some(&joints.chain),
        Motion::Poses(_) => None,
    };
    let motion = fitted(&sampled(&state.motion, SAMPLES * finer.intervals), chain, finer)?.motion;
    let mut finer = (model.clone(), State { motion, parameters: state.parameters.clone() });
    bridge::cover(&mut finer.0, &finer.1);
    Some(finer)
}

/// The longest time from sample to sample of what holds the control points, s: both sensors hold those of poses, the log alone those of joints, of which
/// several may move the sensor alike.
fn holding_step_s(model: &Model<'_>) -> f64 {
    let step_s = |times: &[f64]| (times[times.len() - 1] - times[0]) / times.len() as f64;
    match model.log.log {
        ReferenceLog::Poses(_) if model.streams.len() == SensorKind::ALL.len() => {
            model.streams.iter().map(|stream| step_s(stream.recording.times_s())).fold(0.0, f64::max)
        }
        log => step_s(log.times_s()),
    }
}

/// A motion at even times, as a log.
fn sampled(motion: &Motion, intervals: usize) -> ReferenceLog {
    let knots = motion.knots();
    let time_s = |k: usize| knots.start_s + (knots.end_s() - knots.start_s) * k as f64 / intervals as f64;
    let times_s: Vec<f64> = (0..=intervals).map(time_s).collect();
    match motion {
        Motion::Joints(joints) => ReferenceLog::Joints(JointLog {
            names: vec![String::new(); joints.positions.dimension],
            positions: times_s.iter().flat_map(|time_s| joints.positions.at(*time_s, 0)).collect(),
            velocities: None,
            times_s,
        }),
        Motion::Poses(poses) => ReferenceLog::Poses(PoseLog {
            positions_m: times_s
                .iter()
                .map(|time_s| Some(nalgebra::Vector3::from_vec(poses.position.at(*time_s, 0))))
                .collect(),
            world_from_body: times_s
                .iter()
                .map(|time_s| Some(poses.orientation.at(*time_s).world_from_body))
                .collect(),
            times_s,
        }),
    }
}
