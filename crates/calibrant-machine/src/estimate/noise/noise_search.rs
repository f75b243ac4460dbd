//! The noise of sensors and log, from the residuals.

use super::{Posterior, Sums};
use crate::estimate::least_squares::{Model, Moments, Pass, Residual, State, equations_at, stepped};
use crate::estimate::problem::unsolved;
use crate::estimate::{MachineProblem, MachineSettings, MachineTrust};
use calibrant_core::error::Result;

/// The noise is known when no variance changes by more than this, relatively.
const NOISE_TOLERANCE: f64 = 0.02;
/// The variance components converge geometrically; a step this many times longer arrives sooner.
const RELAXATION: f64 = 1.2;
/// Step of the parameters up to which the noise may count as known, in standard deviations.
const STEP_TOLERANCE: f64 = 0.1;

/// Squares of whitened residuals beyond this are outliers, not noise that grows.
const OUTLYING: f64 = 50.0;

/// `κ` of each stream and of each component of the log.
pub(crate) struct Growths {
    pub(crate) streams: Vec<Option<f64>>,
    pub(crate) log: Option<f64>,
}

impl Growths {
    /// Lets the noise of the samples grow with the activity at their times.
    pub(crate) fn apply(&self, model: &mut Model<'_>, state: &State, activity: &Activity) {
        let grown = |factor: f64, time_s: f64| (1.0 + factor * activity.at(time_s)).sqrt();
        for (s, factor) in self.streams.iter().enumerate() {
            let Some(factor) = *factor else { continue };
            let samples = 0..model.streams[s].recording.len();
            model.streams[s].growth =
                samples.map(|k| grown(factor, model.motion_time(s, k, state))).collect();
        }
        if let Some(factor) = self.log {
            let times = model.log.log.times_s();
            model.log.growth = times.iter().map(|time_s| grown(factor, *time_s)).collect();
        }
    }
}

/// Steps and noise in turn, until both stay. Then noise that grows with motion is looked for, once.
pub(crate) fn noise_search(
    model: &mut Model<'_>,
    state: &mut State,
    problem: &MachineProblem<'_>,
    settings: &MachineSettings,
) -> Result<Growths> {
    /// Number of intervals whose residuals suffice for the noise.
    const INTERVALS: usize = 200;
    /// The same where the motion is known: number of samples of each sensor.
    const SAMPLES: usize = 4000;
    let pass = match model.trust {
        MachineTrust::Known => Pass::trusting(SAMPLES),
        MachineTrust::Noisy => Pass::all(MachineTrust::Noisy),
    };
    let mut growths = Growths { streams: vec![None; model.streams.len()], log: None };
    let mut searched = false;
    for round in 1..=settings.max_noise_rounds {
        settings.interruption.check()?;
        settings.progress.tell("noise", round as u64, settings.max_noise_rounds as u64);
        let here = equations_at(model, state.clone(), pass).ok_or_else(unsolved)?;
        let posterior = Posterior::at(model, &here, pass, INTERVALS).ok_or_else(unsolved)?;
        *state = stepped(model, &here, 1.0);
        let change = update_noise(model, &posterior.sums, problem);
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
fn update_noise(model: &mut Model<'_>, sums: &Sums, problem: &MachineProblem<'_>) -> f64 {
    let mut change = 0.0_f64;
    let mut update = |sd: &mut f64, moments: &Moments, least: f64| {
        if let Some(factor) = moments.variance_factor().filter(|factor| *factor > 0.0) {
            let before = *sd;
            *sd = (before * factor.powf(0.5 * RELAXATION)).max(least);
            change = change.max(2.0 / RELAXATION * (*sd / before).ln().abs());
        }
    };
    for (stream, moments) in model.streams.iter_mut().zip(&sums.streams) {
        if problem.setup.noise_of(stream.sensor).is_none() {
            stream.sd.iter_mut().zip(moments).for_each(|(sd, moments)| update(sd, moments, 0.0));
        }
    }
    if problem.setup.reference_noise.is_none() && model.trust == MachineTrust::Noisy {
        let log = model.log.sd.iter_mut().zip(&sums.log).zip(&model.log.rounding_sd);
        log.for_each(|((sd, moments), least)| update(sd, moments, *least));
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
    let activity = Activity::along(model, state);
    let mut found = false;
    for s in 0..model.streams.len() {
        if problem.setup.noise_of(model.streams[s].sensor).is_some() {
            continue;
        }
        let sd = model.streams[s].sd;
        let residuals = model.residuals(state, s, Pass::all(model.trust));
        let square = |of: Residual| {
            let whitened = of.value.component_div(&sd).norm_squared() / 3.0;
            (whitened < OUTLYING).then(|| (activity.at(of.time_s), whitened))
        };
        if let Some(factor) = growth(&mut residuals.into_iter().filter_map(square).collect::<Vec<_>>()) {
            growths.streams[s] = Some(factor);
            found = true;
        }
    }
    if model.trust == MachineTrust::Noisy && problem.setup.reference_noise.is_none() {
        let times = model.log.log.times_s();
        let mut pairs = Vec::new();
        model.log.visit(0..times.len(), &state.motion, |of| {
            let whitened = (of.residual / model.log.sd[of.component]).powi(2);
            if whitened < OUTLYING {
                pairs.push((activity.at(times[of.sample]), whitened));
            }
        });
        if let Some(factor) = growth(&mut pairs) {
            growths.log = Some(factor);
            found = true;
        }
    }
    growths.apply(model, state, &activity);
    found
}

/// Time between the values, s.
const STEP_S: f64 = 0.05;
/// The activity is averaged over this time to either side, s.
const ABOUT_S: f64 = 0.25;

/// Mean square of rate and of specific force, each in parts of its mean square over the recording; 0 at rest.
pub(crate) struct Activity {
    start_s: f64,
    values: Vec<f64>,
}

impl Activity {
    pub(crate) fn along(model: &Model<'_>, state: &State) -> Self {
        let knots = state.motion.knots();
        let carrier = model.carrier(state);
        let mut joints = Default::default();
        let count = ((knots.end_s() - knots.start_s) / STEP_S) as usize + 1;
        let gravity = state.parameters.gravity_mps2;
        let (mut rates, mut forces) = (vec![0.0; count], vec![0.0; count]);
        for k in 0..count {
            let weights = knots.weights(knots.start_s + k as f64 * STEP_S);
            if model.covered[weights.interval] {
                let at = state.motion.sensor(&weights, &carrier, &mut joints);
                rates[k] = at.rate.norm_squared();
                forces[k] = (at.specific_force.norm() - gravity).powi(2);
            }
        }
        let mean = |values: &[f64]| (values.iter().sum::<f64>() / count as f64).max(f64::MIN_POSITIVE);
        let (of_rate, of_force) = (mean(&rates), mean(&forces));
        let each: Vec<f64> =
            rates.iter().zip(&forces).map(|(r, f)| 0.5 * (r / of_rate + f / of_force)).collect();
        let about = (ABOUT_S / STEP_S) as usize;
        let smooth = |k: usize| {
            let near = &each[k.saturating_sub(about)..(k + about + 1).min(count)];
            near.iter().sum::<f64>() / near.len() as f64
        };
        Self { start_s: knots.start_s, values: (0..count).map(smooth).collect() }
    }

    /// The activity at a time.
    pub(crate) fn at(&self, time_s: f64) -> f64 {
        let place = ((time_s - self.start_s) / STEP_S).max(0.0) as usize;
        self.values[place.min(self.values.len() - 1)]
    }
}

/// The factor `κ` of `σ² (1 + κ a)` by which the variance grows with the activity `a`, from squared whitened residuals. `None` where growth is not significant.
///
/// Two equations: the mean square of the quieter half of the samples, and that of the livelier half.
pub(crate) fn growth(pairs: &mut [(f64, f64)]) -> Option<f64> {
    /// Fewest samples.
    const FEWEST: usize = 400;
    /// The livelier half must be this many times noisier.
    const LEAST: f64 = 1.3;
    if pairs.len() < FEWEST {
        return None;
    }
    let middle = pairs.len() / 2;
    pairs.select_nth_unstable_by(middle, |one, other| one.0.total_cmp(&other.0));
    let mean = |part: &[(f64, f64)]| {
        let n = part.len() as f64;
        part.iter().fold((0.0, 0.0), |(a, r), pair| (a + pair.0 / n, r + pair.1 / n))
    };
    let ((a0, v0), (a1, v1)) = (mean(&pairs[..middle]), mean(&pairs[middle..]));
    if v1 < LEAST * v0 || a1 <= a0 {
        return None;
    }
    // v = s (1 + κ a)
    let slope = (v1 - v0) / (a1 - a0);
    let at_rest = (v0 - slope * a0).max(0.05 * v0);
    Some(slope / at_rest)
}
