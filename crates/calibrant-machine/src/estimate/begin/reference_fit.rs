//! The splines through a log: where the iteration begins, and the motion itself where the log is trusted.

use crate::chain::KinematicChain;
use crate::log::ReferenceLog;
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
            })
        }
        ReferenceLog::Joints(log) => {
            let fit = fit_vectors(&log.times_s, &log.positions, log.names.len(), knots);
            Some(MotionOfLog {
                motion: Motion::Joints(JointMotion { chain: chain?.clone(), positions: fit.spline }),
                sd: fit.sd,
                outliers: fit.outliers,
            })
        }
    }
}

/// A pause in the log of more than this many knot distances, or samples, is a gap.
const GAP: f64 = 3.0;

/// Is each interval free of a gap in the log? A gap is longer than three usual steps of the log and than three knot distances.
pub(crate) fn covered(log: &ReferenceLog, knots: &UniformKnots) -> Vec<bool> {
    let mut covered = vec![true; knots.intervals];
    for times in seen_times(log) {
        let Some((first, last)) = times.first().zip(times.last()) else {
            return vec![false; knots.intervals];
        };
        let usual = (last - first) / times.len() as f64;
        let gap = GAP * usual.max(knots.step_s);
        let mut mark = |from: f64, to: f64| {
            if to > from {
                covered[knots.interval(from)..=knots.interval(to)].fill(false);
            }
        };
        mark(knots.start_s, first - gap);
        mark(last + gap, knots.end_s());
        for pair in times.windows(2).filter(|pair| pair[1] - pair[0] > gap) {
            mark(pair[0], pair[1]);
        }
    }
    covered
}

/// Times at which each part of the log was seen: positions and orientations, or each joint.
fn seen_times(log: &ReferenceLog) -> Vec<Vec<f64>> {
    match log {
        ReferenceLog::Poses(log) => {
            let times = |seen: &dyn Fn(usize) -> bool| -> Vec<f64> {
                (0..log.times_s.len()).filter(|k| seen(*k)).map(|k| log.times_s[k]).collect()
            };
            vec![times(&|k| log.positions_m[k].is_some()), times(&|k| log.world_from_body[k].is_some())]
        }
        ReferenceLog::Joints(log) => {
            let n = log.names.len();
            (0..n)
                .map(|j| {
                    let seen = |k: &usize| log.positions[k * n + j].is_finite();
                    (0..log.times_s.len()).filter(seen).map(|k| log.times_s[k]).collect()
                })
                .collect()
        }
    }
}
