//! The knots of the splines: from the waypoints of the machine, or from the bandwidth of the data.
//!
//! Knots that are too far apart cannot follow the motion; knots that are too near follow the noise of the log, which two derivatives amplify by the square of
//! the frequency. The sensor tells both: its residuals against the smoothed log are least at the best distance. Noisy trust, where the sensor determines the
//! motion with the log, needs less smoothing: half that distance.

use super::initial::{Initial, check_log, refused};
use super::reference_fit::fitted;
use super::trusted::{Effort, trusted};
use super::{MachineProblem, MachineTrust};
use crate::spline::{Degree, UniformKnots};
use calibrant_core::error::Result;
use std::f64::consts::SQRT_2;

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
    let mut refusal = None;
    let mut best: Option<(f64, f64)> = None;
    let mut try_step = |step_s: f64, best: &mut Option<(f64, f64)>| -> bool {
        let score = on(step_s, Degree::Quintic).map(|mut candidate| score(&mut candidate));
        match score {
            Ok(Some(score)) if best.is_none_or(|(least, _)| score < least) => *best = Some((score, step_s)),
            Ok(_) => return false,
            // too few knots for this motion, perhaps
            Err(error) => {
                refusal = Some(error);
                return true;
            }
        }
        true
    };
    // factors of two, until the residuals grow twice; then between them
    let mut step_s = LONGEST_S.min((last - first) / 8.0).max(finest);
    let mut worse = 0;
    while step_s >= finest && worse < 2 {
        let better = try_step(step_s, &mut best) || best.is_none();
        worse = if better { 0 } else { worse + 1 };
        step_s *= 0.5;
    }
    if let Some((_, middle)) = best {
        for step_s in [middle * SQRT_2, middle / SQRT_2].into_iter().filter(|step| *step >= finest) {
            try_step(step_s, &mut best);
        }
    }
    match (best, refusal) {
        (Some((_, step_s)), _) => match problem.setup.trust {
            MachineTrust::Known => on(step_s, Degree::Quintic),
            MachineTrust::Noisy => on((0.5 * step_s).max(finest), Degree::Quintic),
        },
        (None, Some(error)) => Err(error),
        (None, None) => on(step_s.max(finest), Degree::Quintic),
    }
}

/// Sum of the logarithms of the residuals with a trusted motion.
fn score(candidate: &mut Initial<'_>) -> Option<f64> {
    trusted(&mut candidate.model, &mut candidate.state, Effort::QUICK)?;
    let of = |sd: &nalgebra::Vector3<f64>| sd.iter().map(|sd| sd.ln()).sum::<f64>();
    let score = candidate.model.streams.iter().map(|stream| of(&stream.sd)).sum::<f64>();
    score.is_finite().then_some(score)
}
