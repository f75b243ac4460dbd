//! The stages of a calibration on a machine.

use crate::estimate::begin::{Initial, bridge, fitted, initial, refined, suspect, trusted};
use crate::estimate::least_squares::{Minimum, Model, Pass, State, minimise, white_noise};
use crate::estimate::noise::{Growths, Posterior, noise_search};
use crate::estimate::problem::{refused, unsolved};
use crate::estimate::result::{assembled, checks, flexure, undetermined};
use crate::estimate::{MachineCalibration, MachineProblem, MachineSettings, MachineTrust};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::CalibrationStatus;

/// Steps with a trusted motion, and samples of each sensor, that bring the parameters near.
const STEPS: usize = 2;
const SAMPLES: usize = 1000;

/// Nearer knots leave this part of the residuals at most, or they follow noise.
const LEFT: f64 = 0.95;

/// Residuals about the smoothed log that are this many times the noise are of another motion: what smoothing leaves of a log's noise is less.
const OTHER_MOTION: f64 = 100.0;

/// Largest number of intervals from which residuals and budget are computed.
const INTERVALS: usize = 3000;

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
/// - [`Error::Recording`](calibrant_core::Error::Recording): recording and log do not overlap, or cannot be used.
/// - [`Error::NotIdentifiable`](calibrant_core::Error::NotIdentifiable) names what the motion does not determine, and the motion that would.
/// - [`Error::Experiment`](calibrant_core::Error::Experiment): a log of joints without a chain, or of other joints; or the work was interrupted.
pub fn calibrate_on_machine(
    problem: &MachineProblem<'_>,
    settings: &MachineSettings,
) -> Result<MachineCalibration> {
    match as_given(problem, settings) {
        Ok(mut calibration) => {
            if checks::contradict(&calibration) {
                calibration.sensors.warnings.splice(0..0, suspect(problem));
            }
            Ok(calibration)
        }
        Err(Error::Recording(refused)) if refused.code == Refusal::MachineUnsolved => {
            let found = suspect(problem).map(|found| format!("{}. {}", refused.message, found.sentence()));
            let message = found.unwrap_or_else(|| refused.message.clone());
            Err(Error::recording(InputError { message, ..*refused }))
        }
        Err(error) => Err(error),
    }
}

/// The calibration with the log as it is.
fn as_given(problem: &MachineProblem<'_>, settings: &MachineSettings) -> Result<MachineCalibration> {
    let Initial { mut model, mut state, outliers } = initial(problem)?;
    undetermined::check(&model, &state)?;
    trusted(&mut model, &mut state, STEPS, SAMPLES).ok_or_else(unsolved)?;
    // what is another motion is not worth the search for its noise
    if residual_excess(&model, &state) > OTHER_MOTION && suspect(problem).is_some() {
        // the refusal is worded with the suspect
        return Err(refused("recording and log do not fit together", "correct it, and calibrate again"));
    }
    for stream in &mut model.streams {
        match problem.setup.noise_of(stream.sensor) {
            Some(given) => stream.sd = given,
            // the residuals have the errors of the smoothed log, which the sensor corrects
            None if model.trust == MachineTrust::Noisy => stream.sd = white_noise(stream.recording),
            None => {}
        }
    }
    bridge(&mut model, &mut state);
    let mut found = Found::from(model, state, outliers, problem, settings)?;
    while problem.setup.knot_step_s.is_none() && found.may_lack_knots() {
        let Some((model, state)) = refined(&found.model, &found.minimum.state) else { break };
        let knots = state.motion.knots();
        let outliers = fitted(problem.log, problem.chain, knots).map_or_else(Vec::new, |of| of.outliers);
        let finer = Found::from(model, state, outliers, problem, settings)?;
        if !finer.is_better_than(&found) {
            break;
        }
        found = finer;
    }
    let Found { model, growths, minimum, outliers } = found;
    let posterior =
        Posterior::at(&model, &minimum, Pass::all(model.trust), INTERVALS).ok_or_else(unsolved)?;
    let mut calibration = assembled(problem, &model, &minimum, &posterior, &growths, outliers);
    let flexure = flexure::find(&model, &minimum, &calibration);
    checks::add(problem.setup, &model.layout, &mut calibration, flexure);
    Ok(calibration)
}

/// A minimum with the noise that its residuals show.
struct Found<'a> {
    model: Model<'a>,
    growths: Growths,
    minimum: Minimum,
    /// Outliers of each component of the log, about splines on these knots.
    outliers: Vec<usize>,
}

impl<'a> Found<'a> {
    fn from(
        mut model: Model<'a>,
        mut state: State,
        outliers: Vec<usize>,
        problem: &MachineProblem<'_>,
        settings: &MachineSettings,
    ) -> Result<Self> {
        let growths = noise_search(&mut model, &mut state, problem, settings)?;
        let minimum = minimise(&model, state, settings)?.ok_or_else(unsolved)?;
        Ok(Self { model, growths, minimum, outliers })
    }

    /// Are residuals larger than noise, or the log full of outliers, and not so that it is of another motion?
    fn may_lack_knots(&self) -> bool {
        let excess = self.excess();
        let samples: usize = (0..self.outliers.len()).map(|k| self.model.log.samples(k)).sum();
        let outliers = self.outliers.iter().sum::<usize>() as f64;
        excess < checks::REFUSED
            && (excess > checks::LARGEST_EXCESS || outliers > checks::OUTLIERS * samples as f64)
    }

    /// Do these knots follow the motion where the others could not?
    fn is_better_than(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|of| of.outliers.iter().sum::<usize>());
        self.minimum.status == CalibrationStatus::Converged
            && (self.excess() < LEFT * other.excess() || 2 * own < others)
    }

    fn excess(&self) -> f64 {
        residual_excess(&self.model, &self.minimum.state)
    }
}

/// The largest ratio of a sensor's residuals to the noise that neighbouring samples do not share.
fn residual_excess(model: &Model<'_>, state: &State) -> f64 {
    let of = |s: usize| {
        let stream = &model.streams[s];
        let residuals = model.residuals(state, s, Pass::trusting(SAMPLES));
        let squares: f64 = residuals.iter().map(|of| of.value.norm_squared()).sum();
        let white = white_noise(stream.recording).norm_squared();
        (squares / (residuals.len() as f64).max(1.0) / white).sqrt()
    };
    (0..model.streams.len()).map(of).fold(0.0, f64::max)
}
