//! The knots of the splines: from the waypoints of the machine, or from the bandwidth of the data.
//!
//! Knots that are too far apart cannot follow the motion; knots that are too near follow the noise of the log, which two derivatives amplify by the square of
//! the frequency. The sensor tells both: its residuals against the smoothed log are least at the best distance. Noisy trust, where the sensor determines the
//! motion with the log, needs less smoothing: half that distance.

use super::initial::{Initial, check_log, refused};
use super::reference_fit::fitted;
use super::trusted::trusted;
use super::{MachineProblem, MachineTrust};
use crate::spline::{Degree, UniformKnots};
use calibrant_core::error::Result;

/// Candidates per factor of two.
const PER_OCTAVE: f64 = 2.0;
/// Largest distance that is tried, s.
const LONGEST_S: f64 = 0.4;

/// Model and state before the first step, on knots that are given or found.
pub(super) fn initial<'a>(problem: &MachineProblem<'a>) -> Result<Initial<'a>> {
    check_log(problem)?;
    let times = problem.log.times_s();
    let (first, last) = (times[0], times[times.len() - 1]);
    let on = |step_s: f64, degree: Degree| -> Result<Initial<'a>> {
        let fit = fitted(problem.log, problem.chain, UniformKnots::covering(first, last, step_s, degree));
        let nothing = || refused("the log has no usable sample", "look at it with `calibrant inspect`");
        Initial::on(problem, fit.ok_or_else(nothing)?)
    };
    if let Some(step_s) = problem.setup.knot_step_s {
        return on(step_s, Degree::Cubic);
    }
    let finest = 2.0 * (last - first) / times.len() as f64;
    let mut step_s = LONGEST_S.min((last - first) / 8.0).max(finest);
    let mut best: Option<(f64, f64)> = None;
    let mut refusal = None;
    let mut worse = 0;
    while step_s >= finest && worse < 2 {
        match on(step_s, Degree::Quintic) {
            Ok(mut candidate) => match score(&mut candidate) {
                Some(score) if best.is_none_or(|(least, _)| score < least) => {
                    best = Some((score, step_s));
                    worse = 0;
                }
                _ => worse += 1,
            },
            // too few knots for this motion, perhaps
            Err(error) => refusal = Some(error),
        }
        step_s *= 0.5_f64.powf(1.0 / PER_OCTAVE);
    }
    match (best, refusal) {
        (Some((_, step_s)), _) => match problem.setup.trust {
            MachineTrust::Known => on(step_s, Degree::Quintic),
            MachineTrust::Noisy => on((0.5 * step_s).max(finest), Degree::Quintic),
        },
        (None, Some(error)) => Err(error),
        (None, None) => on(step_s, Degree::Quintic),
    }
}

/// Sum of the logarithms of the residuals with a trusted motion.
fn score(candidate: &mut Initial<'_>) -> Option<f64> {
    trusted(&mut candidate.model, &mut candidate.state)?;
    let of = |sd: &nalgebra::Vector3<f64>| sd.iter().map(|sd| sd.ln()).sum::<f64>();
    let score = candidate.model.streams.iter().map(|stream| of(&stream.sd)).sum::<f64>();
    score.is_finite().then_some(score)
}
