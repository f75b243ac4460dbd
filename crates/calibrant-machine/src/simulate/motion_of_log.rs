//! The motion that a log describes, for a simulation of it.

use crate::chain::KinematicChain;
use crate::estimate::{MotionOfLog, fitted};
use crate::log::ReferenceLog;
use crate::spline::{Degree, UniformKnots};

/// Largest distance of knots that is tried, s.
const LONGEST_S: f64 = 0.4;
/// Knots that are nearer must lower the residuals by this factor.
const BETTER: f64 = 0.8;
/// Fewest samples of a log.
const FEWEST: usize = 8;

/// The motion of a log whose joints are those of the chain: cubic splines between way-points where their distance is given, otherwise quintic splines. Their
/// knots are as near as the log has content: until nearer ones no longer follow it better. `None` where the log has too few samples.
#[must_use]
pub fn motion_of_log(
    log: &ReferenceLog,
    chain: Option<&KinematicChain>,
    knot_step_s: Option<f64>,
) -> Option<MotionOfLog> {
    let times = log.times_s();
    let (first, last) = (*times.first()?, *times.last()?);
    if times.len() < FEWEST || last <= first {
        return None;
    }
    let on = |step_s: f64, degree| fitted(log, chain, UniformKnots::covering(first, last, step_s, degree));
    if let Some(step_s) = knot_step_s {
        return on(step_s, Degree::Cubic);
    }
    let finest = (last - first) / (times.len() - 1) as f64;
    let mut step_s = LONGEST_S.min((last - first) / 8.0).max(finest);
    let mut fit = on(step_s, Degree::Quintic)?;
    while 0.5 * step_s >= finest {
        step_s *= 0.5;
        let nearer = on(step_s, Degree::Quintic)?;
        if nearer.sd.iter().zip(&fit.sd).all(|(nearer, sd)| *nearer > BETTER * sd) {
            break;
        }
        fit = nearer;
    }
    Some(fit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::chains_for_tests::{Numbers, mixed_chain};
    use crate::log::JointLog;
    use crate::reference::Motion;

    #[test]
    fn it_follows_the_log_and_not_its_noise() {
        let mut numbers = Numbers(3);
        let chain = mixed_chain(1, &mut numbers);
        for (noise, largest) in [(0.0, 1e-4), (1e-4, 0.05)] {
            let times_s: Vec<f64> = (0..4000).map(|k| 0.005 * f64::from(k)).collect();
            let at = |t: f64| (3.0 * t).sin();
            let positions = times_s.iter().map(|t| at(*t) + numbers.next(noise)).collect();
            let names = vec![chain.joints[0].name.clone()];
            let log = ReferenceLog::Joints(JointLog { names, times_s, positions, velocities: None });
            let found = motion_of_log(&log, Some(&chain), None).expect("a motion");
            let Motion::Joints(motion) = &found.motion else { panic!("of joints") };
            for t in [2.0, 7.7, 15.3] {
                let acceleration = motion.positions.at(t, 2)[0];
                assert!((acceleration + 9.0 * at(t)).abs() < largest, "{noise} {t}: {acceleration}");
            }
        }
        let names = vec![chain.joints[0].name.clone()];
        let short = JointLog { names, times_s: vec![0.0; 3], positions: vec![0.0; 3], velocities: None };
        assert!(motion_of_log(&ReferenceLog::Joints(short), Some(&chain), None).is_none());
    }
}
