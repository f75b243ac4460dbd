//! The stages of a calibration on a machine.

use super::activity::{Activity, growth};
use super::assembly::assembled;
use super::gauss_newton::{equations_at, minimise, stepped};
use super::initial::Initial;
use super::knot_choice::initial;
use super::model::{Model, State};
use super::posterior::Posterior;
use super::trusted::{Effort, trusted};
use super::{MachineCalibration, MachineProblem, MachineSettings, MachineTrust, checks, undetermined};
use calibrant_core::error::{Error, InputError, Refusal, Result};

/// The noise is known when no variance changes by more than this, relatively.
const NOISE_TOLERANCE: f64 = 0.02;
/// The variance components converge geometrically; a step this many times longer arrives sooner.
const RELAXATION: f64 = 1.2;
/// Step of the parameters up to which the noise may count as known, in standard deviations.
const STEP_TOLERANCE: f64 = 0.1;

/// Calibrates a sensor on a machine.
///
/// With `trust` known the smoothed log is the motion. With `trust` noisy the control points of its splines are unknown; the log and the sensor
/// determine them together:
///
/// ```text
/// minimise over p, c:  ½ Σ ‖y_a − S_a f − b_a‖² + ½ Σ ‖y_g − S_g w − b_g − Γ f‖² + ½ Σ ‖log − motion(c)‖² + ½ ‖p − p̄‖²_{Σ_p⁻¹}
/// ```
///
/// each term divided by its variance. Noise that is not given follows from the residuals (variance components with the leverages of the samples).
/// Time and memory are linear in the duration.
///
/// # Errors
/// - [`Error::Recording`]: recording and log do not overlap, or cannot be used.
/// - [`Error::NotIdentifiable`] names what the motion does not determine, and the motion that would.
/// - [`Error::Experiment`]: a log of joints without a chain, or of other joints.
pub fn calibrate_on_machine(
    problem: &MachineProblem<'_>,
    settings: &MachineSettings,
) -> Result<MachineCalibration> {
    let Initial { mut model, mut state, outliers } = initial(problem)?;
    undetermined::check(&model, &state)?;
    trusted(&mut model, &mut state, Effort::THOROUGH).ok_or_else(failed)?;
    for stream in &mut model.streams {
        if let Some(given) = problem.setup.noise_of(stream.sensor) {
            stream.sd = given;
        }
    }
    let growths = noise_search(&mut model, &mut state, problem, settings)?;
    let minimum = minimise(&model, state, settings.max_iterations, settings.tolerance).ok_or_else(failed)?;
    let posterior = Posterior::at(&model, &minimum, 1).ok_or_else(failed)?;
    let mut calibration = assembled(problem, &model, &minimum, &posterior, &growths, outliers);
    calibration.warnings = checks::all(problem, &calibration);
    Ok(calibration)
}

/// The equations cannot be solved: a value is not finite, or nothing is determined.
fn failed() -> Error {
    Error::recording(InputError::new(
        Refusal::MachineUnsolved,
        "the recording does not fit the log of the machine: the equations have no solution",
        "check that both are of the same motion, the units, the order of the joints, and the mounting",
    ))
}

/// `κ` of each stream and of each component of the log.
pub(super) struct Growths {
    pub(super) streams: Vec<Option<f64>>,
    pub(super) log: Option<f64>,
}

/// Steps and noise in turn, until both stay. Then noise that grows with motion is looked for, once.
fn noise_search(
    model: &mut Model<'_>,
    state: &mut State,
    problem: &MachineProblem<'_>,
    settings: &MachineSettings,
) -> Result<Growths> {
    /// The search looks at every so many intervals.
    const EVERY: usize = 4;
    let mut growths = Growths { streams: vec![None; model.streams.len()], log: None };
    let mut searched = false;
    for _ in 0..settings.max_noise_rounds {
        let here = equations_at(model, state.clone()).ok_or_else(failed)?;
        let posterior = Posterior::at(model, &here, EVERY).ok_or_else(failed)?;
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
