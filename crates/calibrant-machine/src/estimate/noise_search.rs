//! The noise of sensors and log, from the residuals.

use super::activity::{Activity, growth};
use super::gauss_newton::{equations_at, stepped};
use super::model::{Model, State};
use super::posterior::Posterior;
use super::unsolved::unsolved;
use super::{MachineProblem, MachineSettings, MachineTrust};
use calibrant_core::error::Result;

/// The noise is known when no variance changes by more than this, relatively.
const NOISE_TOLERANCE: f64 = 0.02;
/// The variance components converge geometrically; a step this many times longer arrives sooner.
const RELAXATION: f64 = 1.2;
/// Step of the parameters up to which the noise may count as known, in standard deviations.
const STEP_TOLERANCE: f64 = 0.1;

/// `κ` of each stream and of each component of the log.
pub(super) struct Growths {
    pub(super) streams: Vec<Option<f64>>,
    pub(super) log: Option<f64>,
}

/// Steps and noise in turn, until both stay. Then noise that grows with motion is looked for, once.
pub(super) fn noise_search(
    model: &mut Model<'_>,
    state: &mut State,
    problem: &MachineProblem<'_>,
    settings: &MachineSettings,
) -> Result<Growths> {
    /// The residuals of every fourth interval suffice for the noise.
    const EVERY: usize = 4;
    let mut growths = Growths { streams: vec![None; model.streams.len()], log: None };
    let mut searched = false;
    for _ in 0..settings.max_noise_rounds {
        let here = equations_at(model, state.clone()).ok_or_else(unsolved)?;
        let posterior = Posterior::at(model, &here, EVERY).ok_or_else(unsolved)?;
        *state = stepped(model, &here, 1.0);
        let change = update_noise(model, &posterior, problem);
        if change < NOISE_TOLERANCE && here.last_step < STEP_TOLERANCE {
            if searched {
                break;
            }
            searched = true;
            if !find_growth(model, state, problem, &mut growths) {
                break;
            }
        }
    }
    Ok(growths)
}

/// New noise from the residuals. Returns the largest relative change of a variance.
fn update_noise(model: &mut Model<'_>, posterior: &Posterior, problem: &MachineProblem<'_>) -> f64 {
    let mut change = 0.0_f64;
    let setup = problem.setup;
    for (stream, moments) in model.streams.iter_mut().zip(&posterior.streams) {
        if setup.noise_of(stream.sensor).is_some() {
            continue;
        }
        for (sd, moments) in stream.sd.iter_mut().zip(moments) {
            if let Some(factor) = moments.variance_factor().filter(|factor| *factor > 0.0) {
                change = change.max(factor.ln().abs());
                *sd *= factor.powf(0.5 * RELAXATION);
            }
        }
    }
    if setup.reference_noise.is_none() && model.trust == MachineTrust::Noisy {
        for (sd, moments) in model.log.sd.iter_mut().zip(&posterior.log) {
            if let Some(factor) = moments.variance_factor().filter(|factor| *factor > 0.0) {
                change = change.max(factor.ln().abs());
                *sd *= factor.powf(0.5 * RELAXATION);
            }
        }
    }
    change
}

/// Noise that grows with motion. Returns whether any does.
fn find_growth(
    model: &mut Model<'_>,
    state: &State,
    problem: &MachineProblem<'_>,
    growths: &mut Growths,
) -> bool {
    let activity = Activity::of(model, state);
    let mut found = false;
    for s in 0..model.streams.len() {
        if problem.setup.noise_of(model.streams[s].sensor).is_some() {
            continue;
        }
        let mut pairs: Vec<(f64, f64)> = Vec::new();
        let sd = model.streams[s].sd;
        model.visit_residuals(state, s, |time, _, residual| {
            let whitened = residual.component_div(&sd).norm_squared() / 3.0;
            // outliers are not what grows
            if whitened < 50.0 {
                pairs.push((activity.at(time), whitened));
            }
        });
        if let Some(factor) = growth(&mut pairs) {
            let times: Vec<f64> =
                (0..model.streams[s].recording.len()).map(|k| model.motion_time(s, k, state)).collect();
            model.streams[s].growth = times.iter().map(|t| (1.0 + factor * activity.at(*t)).sqrt()).collect();
            growths.streams[s] = Some(factor);
            found = true;
        }
    }
    if model.trust == MachineTrust::Noisy && problem.setup.reference_noise.is_none() {
        let mut pairs: Vec<(f64, f64)> =
            model.log.squares(&state.motion).map(|(time, square)| (activity.at(time), square)).collect();
        if let Some(factor) = growth(&mut pairs) {
            let times = model.log.log.times_s();
            model.log.growth = times.iter().map(|t| (1.0 + factor * activity.at(*t)).sqrt()).collect();
            growths.log = Some(factor);
            found = true;
        }
    }
    found
}
