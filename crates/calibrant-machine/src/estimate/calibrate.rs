//! The stages of a calibration on a machine.

use crate::estimate::begin::{Initial, bridge, initial, refined, suspect, trusted};
use crate::estimate::least_squares::{Minimum, Model, Pass, State, minimise, white_noise};
use crate::estimate::noise::{Growths, Posterior, noise_search};
use crate::estimate::problem::unsolved;
use crate::estimate::result::{assembled, checks, undetermined};
use crate::estimate::{MachineCalibration, MachineProblem, MachineSettings, MachineTrust};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::CalibrationStatus;

/// Steps with a trusted motion, and samples of each sensor, that bring the parameters near.
const STEPS: usize = 2;
const SAMPLES: usize = 1000;

/// Nearer knots leave this part of the residuals at most, or they follow noise.
const LEFT: f64 = 0.95;

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
                calibration.warnings.extend(suspect(problem));
            }
            Ok(calibration)
        }
        Err(Error::Recording(refused)) if refused.code == Refusal::MachineUnsolved => {
            let found = suspect(problem).map(|found| format!("{}. {}", refused.message, found.message()));
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
    for stream in &mut model.streams {
        match problem.setup.noise_of(stream.sensor) {
            Some(given) => stream.sd = given,
            // the residuals have the errors of the smoothed log, which the sensor corrects
            None if model.trust == MachineTrust::Noisy => stream.sd = white_noise(stream.recording),
            None => {}
        }
    }
    bridge(&mut model, &mut state);
    let mut found = Found::from(model, state, problem, settings)?;
    while problem.setup.knot_step_s.is_none() && found.may_lack_knots() {
        let Some((model, state)) = refined(&found.model, &found.minimum.state) else { break };
        let finer = Found::from(model, state, problem, settings)?;
        if finer.minimum.status != CalibrationStatus::Converged || finer.excess() > LEFT * found.excess() {
            break;
        }
        found = finer;
    }
    let Found { model, growths, minimum } = found;
    let posterior =
        Posterior::at(&model, &minimum, Pass::all(model.trust), INTERVALS).ok_or_else(unsolved)?;
    let mut calibration = assembled(problem, &model, &minimum, &posterior, &growths, outliers);
    calibration.warnings = checks::all(problem.setup, &model.layout, &calibration);
    Ok(calibration)
}

/// A minimum with the noise that its residuals show.
struct Found<'a> {
    model: Model<'a>,
    growths: Growths,
    minimum: Minimum,
}

impl<'a> Found<'a> {
    fn from(
        mut model: Model<'a>,
        mut state: State,
        problem: &MachineProblem<'_>,
        settings: &MachineSettings,
    ) -> Result<Self> {
        let growths = noise_search(&mut model, &mut state, problem, settings)?;
        let minimum = minimise(&model, state, settings)?.ok_or_else(unsolved)?;
        Ok(Self { model, growths, minimum })
    }

    /// Are the residuals larger than noise, and not so large that the log is of another motion?
    fn may_lack_knots(&self) -> bool {
        self.minimum.status == CalibrationStatus::Converged
            && (checks::LARGEST_EXCESS..checks::REFUSED).contains(&self.excess())
    }

    /// The largest ratio of a sensor's residuals to the noise that neighbouring samples do not share.
    fn excess(&self) -> f64 {
        let of = |s: usize| {
            let stream = &self.model.streams[s];
            let residuals = self.model.residuals(&self.minimum.state, s, Pass::trusting(SAMPLES));
            let squares: f64 = residuals.iter().map(|of| of.value.norm_squared()).sum();
            let white = white_noise(stream.recording).norm_squared();
            (squares / (residuals.len() as f64).max(1.0) / white).sqrt()
        };
        (0..self.model.streams.len()).map(of).fold(0.0, f64::max)
    }
}
