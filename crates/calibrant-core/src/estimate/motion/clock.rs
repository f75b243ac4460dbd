//! The clock of the recording, estimated with the parameters.
//!
//! Delay and rate are eliminated last. For a given clock the problem is the one without (motion and parameters). At its solution the normal equations
//! with the clock behind the parameters, the motion eliminated, give the next step of the clock (Gauss–Newton). Their inverse has the covariance of the
//! parameters with the clock marginalised.

use super::chain::Solved;
use super::context::Context;
use super::solution::solve_at;
use super::{CalibrationProblem, CalibrationSettings};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::motion::{DelayUnexpected, MotionDelayed};
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::RecoveredClock;
use crate::estimate::alignment::aligned;
use crate::motion::{CommandedMotion, MotionClock, Trust};
use std::ops::Range;

/// Largest number of steps of the clock.
const MOST: usize = 30;
/// A step of this number of standard deviations is the last.
const LAST: f64 = 1e-4;
/// The same where the steps lead no further down: a sample that passes a node changes its slope, so the minimum may lie in a kink.
const IN_A_KINK: f64 = 1e-2;

/// The clock that fits best, and whether the search for it converged.
pub(super) fn find(
    problem: &CalibrationProblem<'_>,
    command: &CommandedMotion,
    settings: &CalibrationSettings,
) -> Result<(RecoveredClock, Range<usize>, bool)> {
    let mut clock = aligned(problem.recording, command, problem.sensor.axes)?;
    let mut used = samples_within(&clock, problem, command)?;
    if command.clock.is_exact() || command.trust == Trust::Unknown {
        return Ok((clock, used, true));
    }
    let mut best: Option<(RecoveredClock, f64)> = None;
    for _ in 0..MOST {
        let recording = clock.on_motion_clock(problem.recording);
        let on_clock = CalibrationProblem { recording: &recording, ..*problem };
        let context = Context::new(&on_clock, command, settings, used.clone())?;
        let solved = solve_at(&context)?;
        let step = solved.clock.and_then(|equations| equations.step(&clock, &command.clock));
        let Some(step) = step.filter(|step| step.delay_s.is_finite() && step.rate.is_finite()) else { break };
        let n = step.covariance.nrows();
        (clock.delay_sd_s, clock.rate_sd) =
            (step.covariance[(n - 2, n - 2)].sqrt(), step.covariance[(n - 1, n - 1)].sqrt());
        let within = |delay_s: f64, rate: f64, part: f64| {
            delay_s.abs() <= part * clock.delay_sd_s && rate.abs() <= part * clock.rate_sd
        };
        let chi2 = solved.chi2 + prior_chi2(&clock);
        if let Some((before, least)) = best
            && chi2 >= least
        {
            let (delay_s, rate) = (0.5 * (clock.delay_s - before.delay_s), 0.5 * (clock.rate - before.rate));
            if within(delay_s, rate, IN_A_KINK) {
                return Ok((before, used, true));
            }
            clock = RecoveredClock { delay_s: before.delay_s + delay_s, rate: before.rate + rate, ..clock };
            continue;
        }
        if within(step.delay_s, step.rate, LAST) {
            return Ok((clock, used, true));
        }
        best = Some((clock, chi2));
        clock.delay_s += step.delay_s;
        clock.rate += step.rate;
        // the samples stay those of the first steps: their number would jump at the ends
        if step.delay_s.abs() > 0.5 * sample_step_s(problem) {
            used = samples_within(&clock, problem, command)?;
            best = None;
        }
    }
    Ok((clock, used, false))
}

/// The samples within the motion. Those outside are not used. Where the clock is estimated, so are those a step from its ends, which the next step of the clock
/// may move outside.
fn samples_within(
    clock: &RecoveredClock,
    problem: &CalibrationProblem<'_>,
    command: &CommandedMotion,
) -> Result<Range<usize>> {
    let (motion, times) = (&command.motion, &problem.recording.times_s);
    let (start, stop) = (motion.times_s()[0], motion.times_s()[motion.intervals()]);
    let slack = match clock.given.is_exact() {
        true => 1e-6 * (stop - start) / motion.intervals() as f64,
        false => -sample_step_s(problem),
    };
    let first = times.partition_point(|&t| clock.motion_time_s(t) < start - slack);
    let end = times.partition_point(|&t| clock.motion_time_s(t) <= stop + slack);
    if first >= end {
        return Err(Error::recording(InputError::new(
            Refusal::MotionInvalid,
            format!(
                "no sample lies within the motion: the recording spans {} to {} s, the motion {start} to {stop} s",
                times[0],
                times[times.len() - 1]
            ),
            "check that both use the same clock and start together; where they do not, set delay_sd_s in [motion.clock]",
        )));
    }
    Ok(first..end)
}

/// The mean distance of two samples.
fn sample_step_s(problem: &CalibrationProblem<'_>) -> f64 {
    let times = &problem.recording.times_s;
    (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64
}

/// Puts the covariance with the clock marginalised into a solution, and the clock's part into χ². An exact clock has none.
pub(super) fn marginalise(solved: &mut Solved, clock: &RecoveredClock) {
    let given = clock.given;
    if given.is_exact() {
        return;
    }
    let Some(step) = solved.clock.as_ref().and_then(|equations| equations.step(clock, &given)) else {
        return;
    };
    let size = solved.values.len();
    solved.covariance = step.covariance.view((0, 0), (size, size)).into_owned();
    solved.chi2 += prior_chi2(clock);
}

/// What is known of the clock, as a part of χ².
fn prior_chi2(clock: &RecoveredClock) -> f64 {
    let given = clock.given;
    let known = [(given.delay_sd_s, clock.delay_s - given.delay_s), (given.rate_sd, clock.rate)];
    known.iter().filter(|(sd, _)| *sd > 0.0).map(|(sd, off)| (off / sd).powi(2)).sum()
}

/// A delay beyond this number of standard deviations is no chance.
const FAR: f64 = 5.0;

/// What the data say against the clock that was given: a delay where it is exact, or another one.
pub(super) fn delayed(solved: &Solved, clock: &RecoveredClock) -> Option<Diagnostic> {
    let given = clock.given;
    if !given.is_exact() {
        let deviations = (clock.delay_s - given.delay_s).abs() / given.delay_sd_s;
        let (delay_s, expected_s, sd_s) = (clock.delay_s, given.delay_s, given.delay_sd_s);
        return (sd_s > 0.0 && deviations > FAR)
            .then(|| DelayUnexpected { delay_s, expected_s, sd_s }.into());
    }
    // the step that a free delay would make
    let free = MotionClock { delay_sd_s: f64::MAX.sqrt(), ..given };
    let step = solved.clock.as_ref()?.step(clock, &free)?;
    let n = step.covariance.nrows();
    let scatter = (solved.chi2 / solved.degrees_of_freedom.max(1) as f64).max(1.0);
    let sd_s = (scatter * step.covariance[(n - 2, n - 2)]).sqrt();
    (step.delay_s.abs() > FAR * sd_s).then(|| MotionDelayed { delay_s: step.delay_s, sd_s }.into())
}
