//! Calibrates an IMU: outliers are taken out first, and what is known beforehand is compared with the recording.

use crate::diagnostic::Diagnostic;
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::checks::known_terms::{self, Contradiction};
use crate::estimate::imu::problem::{ImuProblem, ImuSetup};
use crate::estimate::imu::solver::solve_imu;
use crate::estimate::imu::white_noise_search::WhiteNoiseSearch;
use crate::estimate::result::{Calibration, CalibrationStatus};
use crate::estimate::settings::CalibrationSettings;
use crate::estimate::unknown_latitude::unknown_latitude;

/// Calibrates an IMU.
///
/// # Errors
/// [`Error::Recording`](crate::Error::Recording) where a sensor's recording is missing or is none, where gyroscope and accelerometer do not overlap, or where the
/// gyroscope's readings cannot be angular rates in the unit given; [`Error::Experiment`](crate::Error::Experiment) where the readings contradict the directions of
/// the holds or what is known beforehand; [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) names what the holds or the rotations do not determine, and what would.
pub fn calibrate_imu(problem: &ImuProblem<'_>, settings: &CalibrationSettings) -> Result<Calibration> {
    calibrate_imu_with(problem, settings, &WhiteNoiseSearch::known(problem.setup.white_noise))
}

/// Calibrates an IMU whose gyroscope's white noise is still to be found. The search runs while the accelerometer is fitted, which does not wait for it.
///
/// What it finds counts in place of [`ImuSetup::white_noise`]. Spikes and invalid readings are taken out first
/// ([`ImuRecording::without_spikes`](crate::sensor::ImuRecording::without_spikes)), and warnings say so; not where the holds were found before
/// ([`HoldsSetup::found`](crate::estimate::HoldsSetup::found)).
///
/// # Errors
/// As [`calibrate_imu`].
pub fn calibrate_imu_with(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: &WhiteNoiseSearch<'_>,
) -> Result<Calibration> {
    let mut calibration = match problem.setup.holds.found {
        Some(_) => of_clean(problem, settings, white_noise)?,
        None => without_outliers(problem, settings, white_noise)?,
    };
    calibration.warnings.extend(unknown_latitude(&calibration));
    Ok(calibration)
}

/// The same of a recording of which outliers are still to be taken out.
fn without_outliers(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: &WhiteNoiseSearch<'_>,
) -> Result<Calibration> {
    let (recording, outliers) = problem.recording.without_spikes();
    let mut calibration = of_clean(&ImuProblem { recording: &recording, ..*problem }, settings, white_noise)?;
    let found = outliers.iter().filter_map(|(sensor_kind, outliers)| {
        let unit = problem.recording.sensor(*sensor_kind)?.unit;
        Some(Diagnostic::spikes(outliers, *sensor_kind, unit))
    });
    calibration.warnings.splice(0..0, found);
    Ok(calibration)
}

/// The same of a recording without outliers.
fn of_clean(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: &WhiteNoiseSearch<'_>,
) -> Result<Calibration> {
    let known = &problem.setup.known;
    if known.is_empty() {
        return solve_imu(problem, settings, white_noise);
    }
    known.iter().try_for_each(known_terms::check)?;
    let outcome = solve_imu(problem, settings, white_noise);
    // what is fixed leaves no residual of its own
    let fixed = known.iter().any(|known| known.sd.is_none());
    if let Ok(found) = &outcome
        && !fixed
        && found.status == CalibrationStatus::Converged
        && found.warnings.is_empty()
    {
        return outcome;
    }
    let contradictions = contradictions(problem, settings, white_noise);
    let absurd = contradictions.iter().any(|term| term.is_absurd);
    let stated = contradictions.into_iter().map(|term| term.known);
    match outcome {
        Ok(mut found) if !absurd => {
            found.warnings.splice(0..0, stated.map(|known| Diagnostic::KnownContradicted { known }));
            Ok(found)
        }
        Err(error) if stated.len() == 0 => Err(error),
        _ => Err(Error::experiment(InputError::new(
            Refusal::KnownContradicted,
            stated.map(|known| known.to_string()).collect::<Vec<_>>().join("; "),
            "correct the value in [known], its unit too, or leave it out and let the recording tell",
        ))),
    }
}

/// The given terms that the recording contradicts by far, judged by the fit without any of them.
fn contradictions(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: &WhiteNoiseSearch<'_>,
) -> Vec<Contradiction> {
    let setup = ImuSetup { known: Vec::new(), ..problem.setup.clone() };
    let without = ImuProblem { setup: &setup, ..*problem };
    match solve_imu(&without, settings, white_noise) {
        Ok(without) => known_terms::contradicted(&problem.setup.known, &without),
        Err(_) => Vec::new(),
    }
}
