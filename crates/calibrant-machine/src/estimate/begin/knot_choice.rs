//! The knots of the splines: from the waypoints of the machine, or from the bandwidth of the data.
//!
//! Knots that are too far apart cannot follow the motion; knots that are too near follow the noise of the log, which two derivatives amplify by the square of
//! the frequency. The sensor tells both: its residuals against the smoothed log are least at the best distance. Noisy trust, where the sensor determines the
//! motion with the log, needs less smoothing: half that distance.

use super::{Initial, MotionOfLog, check_log, fitted};
use crate::estimate::least_squares::{Model, Pass, State, equations_at, stepped};
use crate::estimate::problem::refused;
use crate::estimate::{MachineParameters, MachineProblem, MachineTrust};
use crate::spline::{Degree, UniformKnots};
use calibrant_core::error::{Error, Result};
use calibrant_core::sensor::SensorKind;
use std::f64::consts::SQRT_2;

/// Largest distance that is tried, s.
const LONGEST_S: f64 = 0.4;
/// Samples of each sensor by which distances are compared.
const SAMPLES: usize = 800;
/// Steps of the parameters at the first distance, and from those of another one.
const STEPS: [usize; 2] = [4, 1];

/// Model and state before the first step, on knots that are given or found.
pub(crate) fn initial<'a>(problem: &MachineProblem<'a>) -> Result<Initial<'a>> {
    check_log(problem)?;
    if let Some(step_s) = problem.setup.knot_step_s {
        return on(problem, step_s, Degree::Cubic, None);
    }
    let (duration_s, samples) = duration(problem);
    let finest = 2.0 * duration_s / samples as f64;
    let mut search = Search { problem, best: None, refusal: None };
    // factors of two, until the residuals grow twice; then between them
    let mut step_s = LONGEST_S.min(duration_s / 8.0).max(finest);
    let mut worse = 0;
    while step_s >= finest && worse < 2 {
        let better = search.is_best(step_s) || search.best.is_none();
        worse = if better { 0 } else { worse + 1 };
        step_s *= 0.5;
    }
    if let Some(middle) = search.best.as_ref().map(|best| best.step_s) {
        for step_s in [middle * SQRT_2, middle / SQRT_2].into_iter().filter(|step_s| *step_s >= finest) {
            search.is_best(step_s);
        }
    }
    match (search.best, search.refusal) {
        (Some(Candidate { step_s, parameters, .. }), _) => {
            let step_s = match problem.setup.trust {
                MachineTrust::Known => step_s,
                MachineTrust::Noisy => (0.5 * step_s).max(finest),
            };
            on(problem, step_s, Degree::Quintic, Some(&parameters))
        }
        (None, Some(error)) => Err(error),
        (None, None) => on(problem, step_s.max(finest), Degree::Quintic, None),
    }
}

/// Duration, s, and number of samples of the log.
fn duration(problem: &MachineProblem<'_>) -> (f64, usize) {
    let times = problem.log.times_s();
    (times[times.len() - 1] - times[0], times.len())
}

/// Model and state on knots of this distance, from these parameters if they are known already.
fn on<'a>(
    problem: &MachineProblem<'a>,
    step_s: f64,
    degree: Degree,
    parameters: Option<&MachineParameters>,
) -> Result<Initial<'a>> {
    Initial::on(problem, fit(problem, step_s, degree)?, parameters)
}

/// Splines through the log on knots of this distance.
fn fit(problem: &MachineProblem<'_>, step_s: f64, degree: Degree) -> Result<MotionOfLog> {
    let first = problem.log.times_s()[0];
    let knots = UniformKnots::covering(first, first + duration(problem).0, step_s, degree);
    let nothing = || refused("the log has no usable sample", "look at it with `calibrant inspect`");
    fitted(problem.log, problem.chain, knots).ok_or_else(nothing)
}

/// A distance of knots, and what was found with it.
pub(super) struct Candidate {
    step_s: f64,
    /// Sum of the logarithms of the residuals with a trusted motion.
    pub(super) score: f64,
    /// Number of the residuals' components: three for each sensor.
    pub(super) components: usize,
    pub(super) parameters: MachineParameters,
}

/// What is found with knots of this distance, from these parameters if they are known already. `None` where nothing is determined.
pub(super) fn candidate(
    problem: &MachineProblem<'_>,
    step_s: f64,
    known: Option<&MachineParameters>,
) -> Result<Option<Candidate>> {
    let fit = fit(problem, step_s, Degree::Quintic)?;
    let first = Initial::on(problem, fit.clone(), known)?;
    let elsewhere = first.elsewhere(problem);
    let mut best = tried(problem, first, step_s, STEPS[usize::from(known.is_some())]);
    for from in elsewhere {
        let other = tried(problem, Initial::on(problem, fit.clone(), Some(&from))?, step_s, STEPS[0]);
        let least = best.as_ref().map_or(f64::INFINITY, |best| best.score);
        best = other.filter(|other| other.score < least).or(best);
    }
    Ok(best)
}

/// What is found after some steps. `None` where nothing is determined.
fn tried(problem: &MachineProblem<'_>, from: Initial<'_>, step_s: f64, steps: usize) -> Option<Candidate> {
    let Initial { mut model, mut state, .. } = from;
    trusted(&mut model, &mut state, steps, SAMPLES)?;
    let setup = problem.setup;
    let sd = || model.streams.iter().flat_map(|stream| stream.sd.iter());
    // of delays that fit alike, the likelier one: the logarithms are those of each of the samples
    let deviation = (state.parameters.delays_s[SensorKind::Accelerometer] - setup.delay_s) / setup.delay_sd_s;
    let unlikely = if setup.delay_sd_s > 0.0 { 0.5 * deviation * deviation / SAMPLES as f64 } else { 0.0 };
    let score = sd().map(|sd| sd.ln()).sum::<f64>() + unlikely;
    Some(Candidate { step_s, score, components: sd().count(), parameters: state.parameters })
}

struct Search<'p, 'a> {
    problem: &'p MachineProblem<'a>,
    best: Option<Candidate>,
    refusal: Option<Error>,
}

impl Search<'_, '_> {
    /// Is this distance the best so far? One that is refused may have too few knots for the motion: it does not count as worse.
    fn is_best(&mut self, step_s: f64) -> bool {
        let known = self.best.as_ref().map(|best| &best.parameters);
        match candidate(self.problem, step_s, known) {
            Ok(found) => {
                let least = self.best.as_ref().map_or(f64::INFINITY, |best| best.score);
                let better = found.filter(|found| found.score < least);
                let is_best = better.is_some();
                self.best = better.or(self.best.take());
                is_best
            }
            Err(error) => {
                self.refusal = Some(error);
                true
            }
        }
    }
}

/// Fits the parameters to the motion as it is, with the noise that the residuals show. The noise of the model remains so. `None` where
/// nothing is determined.
pub(crate) fn trusted(model: &mut Model<'_>, state: &mut State, steps: usize, samples: usize) -> Option<()> {
    let pass = Pass::trusting(samples);
    noise_of_residuals(model, state, pass);
    for _ in 0..steps {
        *state = stepped(model, &equations_at(model, state.clone(), pass)?, 1.0);
        noise_of_residuals(model, state, pass);
    }
    Some(())
}

fn noise_of_residuals(model: &mut Model<'_>, state: &State, pass: Pass) {
    let rms = model.residual_rms(state, pass);
    for (stream, rms) in model.streams.iter_mut().zip(rms) {
        stream.sd.component_mul_assign(&rms.map(|rms| rms.max(1e-9)));
    }
}
