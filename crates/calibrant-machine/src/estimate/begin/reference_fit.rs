//! The splines through a log: where the iteration begins, and the motion itself where the log is trusted.

use crate::chain::KinematicChain;
use crate::log::{PoseLog, ReferenceLog};
use crate::reference::{JointMotion, Motion, PoseMotion};
use crate::spline::{UniformKnots, fit_rotations, fit_vectors};

/// A motion through a log.
#[derive(Debug, Clone)]
pub struct MotionOfLog {
    /// The motion.
    pub motion: Motion,
    /// Standard deviation of one sample about it, for each joint, or for three axes of position and of orientation; rad or m.
    pub sd: Vec<f64>,
    /// Number of outliers of each component.
    pub outliers: Vec<usize>,
    /// Standard deviation of the rounding of each component.
    pub rounding_sd: Vec<f64>,
}

/// Fits splines on these knots.
pub(crate) fn fitted(
    log: &ReferenceLog,
    chain: Option<&KinematicChain>,
    knots: UniformKnots,
) -> Option<MotionOfLog> {
    match log {
        ReferenceLog::Poses(log) => {
            log.world_from_body.iter().flatten().next()?;
            let nan = [f64::NAN; 3];
            let values: Vec<f64> =
                log.positions_m.iter().flat_map(|p| p.map_or(nan, |p| [p.x, p.y, p.z])).collect();
            let (position, orientation) = rayon::join(
                || fit_vectors(&log.times_s, &values, 3, knots),
                || fit_rotations(&log.times_s, &log.world_from_body, knots),
            );
            let motion = PoseMotion { position: position.spline, orientation: orientation.spline };
            Some(MotionOfLog {
                motion: Motion::Poses(motion),
                sd: [position.sd, orientation.sd_rad].concat(),
                outliers: [position.outliers, orientation.outliers].concat(),
                // a quaternion has decimals, no steps
                rounding_sd: [position.rounding_sd, vec![0.0; 3]].concat(),
            })
        }
        ReferenceLog::Joints(log) => {
            let fit = fit_vectors(&log.times_s, &log.positions, log.names.len(), knots);
            Some(MotionOfLog {
                motion: Motion::Joints(JointMotion { chain: chain?.clone(), positions: fit.spline }),
                sd: fit.sd,
                outliers: fit.outliers,
                rounding_sd: fit.rounding_sd,
            })
        }
    }
}

/// A pause in the log of more than this many knot distances, or samples, is a gap.
const GAP: f64 = 3.0;

/// Is each interval free of a gap in the log? A gap is longer than three usual steps of the log and than three knot distances. Between two orientations it is
/// also longer than what is `bridged_s` otherwise.
pub(crate) fn covered(log: &ReferenceLog, knots: &UniformKnots, bridged_s: f64) -> Vec<bool> {
    let mut covered = vec![true; knots.intervals];
    for (times, bridged_s) in seen_times(log, bridged_s) {
        let Some((first, last)) = times.first().zip(times.last()) else {
            return vec![false; knots.intervals];
        };
        let gap = longest_step(&times, knots.step_s);
        let mut mark = |from: f64, to: f64| {
            if to > from {
                covered[knots.interval(from)..=knots.interval(to)].fill(false);
            }
        };
        mark(knots.start_s, first - gap);
        mark(last + gap, knots.end_s());
        for (from, to) in gaps(&times, knots.step_s).filter(|(from, to)| to - from > bridged_s) {
            mark(from, to);
        }
    }
    covered
}

/// The longest step from time to time that is no gap, s.
fn longest_step(times: &[f64], step_s: f64) -> f64 {
    let usual = (times[times.len() - 1] - times[0]) / times.len() as f64;
    GAP * usual.max(step_s)
}

/// Beginning and end of each gap between times at which something was seen.
pub(super) fn gaps(times: &[f64], step_s: f64) -> impl Iterator<Item = (f64, f64)> {
    let longest = if times.is_empty() { 0.0 } else { longest_step(times, step_s) };
    times.array_windows().filter(move |[from, to]| to - from > longest).map(|[from, to]| (*from, *to))
}

/// Times at which the orientation was seen.
pub(super) fn seen_orientations(log: &PoseLog) -> Vec<f64> {
    let seen = log.times_s.iter().zip(&log.world_from_body);
    seen.filter_map(|(time_s, seen)| seen.map(|_| *time_s)).collect()
}

/// Times at which each part of the log was seen: positions, where there are any, and orientations; or each joint. Beside them, how long a gap is bridged.
fn seen_times(log: &ReferenceLog, bridged_s: f64) -> Vec<(Vec<f64>, f64)> {
    match log {
        ReferenceLog::Poses(log) => {
            let seen = log.times_s.iter().zip(&log.positions_m);
            let positions: Vec<f64> = seen.filter_map(|(time_s, seen)| seen.map(|_| *time_s)).collect();
            let parts = [(positions, 0.0), (seen_orientations(log), bridged_s)];
            parts.into_iter().filter(|(times, _)| !times.is_empty()).collect()
        }
        ReferenceLog::Joints(log) => {
            let n = log.names.len();
            (0..n)
                .map(|j| {
                    let seen = |k: &usize| log.positions[k * n + j].is_finite();
                    let times = (0..log.times_s.len()).filter(seen).map(|k| log.times_s[k]).collect();
                    (times, 0.0)
                })
                .collect()
        }
    }
}
