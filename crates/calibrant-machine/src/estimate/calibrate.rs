//! The stages of a calibration on a machine.

use crate::estimate::begin::{Initial, initial, trusted};
use crate::estimate::least_squares::{Pass, minimise, white_noise};
use crate::estimate::noise::{Posterior, noise_search};
use crate::estimate::problem::unsolved;
use crate::estimate::result::{assembled, checks, undetermined};
use crate::estimate::{MachineCalibration, MachineProblem, MachineSettings, MachineTrust};
use calibrant_core::error::Result;

/// Steps with a trusted motion, and samples of each sensor, that bring the parameters near.
const STEPS: usize = 2;
const SAMPLES: usize = 1000;

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
    let growths = noise_search(&mut model, &mut state, problem, settings)?;
    let minimum = minimise(&model, state, settings)?.ok_or_else(unsolved)?;
    let posterior =
        Posterior::at(&model, &minimum, Pass::all(model.trust), INTERVALS).ok_or_else(unsolved)?;
    let mut calibration = assembled(problem, &model, &minimum, &posterior, &growths, outliers);
    calibration.warnings = checks::all(problem.setup, &model.layout, &calibration);
    Ok(calibration)
}
