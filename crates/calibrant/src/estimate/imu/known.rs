//! What is known beforehand, where the recording contradicts it so much that nothing comes of the fit: the fit without it tells which term it is.

use super::solver;
use super::{ImuCalibration, ImuProblem, ImuSetup, KnownTerm, WhiteNoise};
use crate::error::{Complaint, Error, Result};
use crate::estimate::{CalibrationSettings, CalibrationStatus};

/// Combined standard deviations beyond which a term contradicts the recording.
const CONTRADICTED: f64 = 6.0;
/// Smallest standard deviation of a prior: a smaller one leaves the other data no digits.
const LEAST_SD: f64 = 1e-12;

/// Calibrates an IMU.
///
/// # Errors
/// [`Error::Recording`](crate::Error::Recording) where a sensor's recording is missing or is none, where gyroscope and accelerometer do not overlap, or where the
/// gyroscope's readings cannot be angular rates in the unit given; [`Error::Experiment`](crate::Error::Experiment) where the readings contradict the directions of
/// the holds or what is known beforehand; [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) names what the holds or the rotations do not determine, and what would.
pub fn calibrate_imu(problem: &ImuProblem<'_>, settings: &CalibrationSettings) -> Result<ImuCalibration> {
    calibrate_imu_while(problem, settings, || problem.setup.white_noise)
}

/// The same where the gyroscope's white noise is still to be found: `white_noise` finds it while the accelerometer is fitted, which does not wait for it.
///
/// What it gives counts in place of [`ImuSetup::white_noise`].
///
/// # Errors
/// As [`calibrate_imu`].
pub fn calibrate_imu_while(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: impl FnOnce() -> Option<WhiteNoise> + Send,
) -> Result<ImuCalibration> {
    let known = &problem.setup.known;
    if known.is_empty() {
        return solver::calibrate_imu(problem, settings, white_noise);
    }
    known.iter().try_for_each(possible)?;
    let mut found_noise = None;
    let found = solver::calibrate_imu(problem, settings, || {
        found_noise = white_noise();
        found_noise
    });
    let contradictions = || contradictions(problem, settings, found_noise);
    match found {
        Ok(mut found) => {
            // what is fixed leaves no residual of its own
            let fixed = known.iter().any(|known| known.sd.is_none());
            if fixed || found.status != CalibrationStatus::Converged || !found.warnings.is_empty() {
                found.warnings.splice(0..0, contradictions());
            }
            Ok(found)
        }
        Err(error) => Err(match contradictions().as_slice() {
            [] => error,
            found => Error::experiment(Complaint::new(
                found.join("; "),
                "correct the value in [known], its unit too, or leave it out and let the recording tell",
            )),
        }),
    }
}

fn possible(known: &KnownTerm) -> Result<()> {
    let is_sd = |sd: f64| sd.is_finite() && sd >= LEAST_SD;
    if known.value.is_finite() && known.sd.is_none_or(is_sd) {
        return Ok(());
    }
    let sd = known.sd.map_or_else(String::new, |sd| format!(" ± {sd:?}"));
    Err(Error::experiment(Complaint::new(
        format!("{} cannot be known as {:?}{sd}", known.quantity.name(), known.value),
        format!("a prior has a standard deviation of {LEAST_SD:e} or more; without one the value is fixed"),
    )))
}

/// The terms that the recording contradicts by far, by the fit that knows of none.
fn contradictions(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: Option<WhiteNoise>,
) -> Vec<String> {
    let setup = ImuSetup { known: Vec::new(), ..problem.setup.clone() };
    let without = ImuProblem { setup: &setup, ..*problem };
    let Ok(without) = solver::calibrate_imu(&without, settings, || white_noise) else {
        return Vec::new();
    };
    if without.status != CalibrationStatus::Converged {
        return Vec::new();
    }
    let sds = without.sd();
    let contradiction = |known: &KnownTerm| {
        let place = without.quantities.iter().position(|quantity| *quantity == known.quantity)?;
        let (found, sd) = (known.quantity.of(&without.imu), sds[place]);
        let off = (found - known.value).abs() > CONTRADICTED * sd.hypot(known.sd.unwrap_or(0.0));
        off.then(|| {
            format!(
                "the recording contradicts what [known] says of {}: {:?}, where the recording alone gives {found:.5} ± {sd:.1e}",
                known.quantity.name(),
                known.value
            )
        })
    };
    problem.setup.known.iter().filter_map(contradiction).collect()
}
