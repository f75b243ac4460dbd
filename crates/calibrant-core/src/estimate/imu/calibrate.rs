//! Calibrates an IMU: removes outliers, and compares given values with the recording.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::holds::HoldsSpreadLittle;
use crate::diagnostic::samples::KnocksKept;
use crate::diagnostic::{Check, samples};
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::holds::are_correlated;
use crate::estimate::imu::checks::known_terms::{self, Contradiction};
use crate::estimate::imu::problem::{ImuProblem, ImuSetup};
use crate::estimate::imu::solver::solve_imu;
use crate::estimate::imu::white_noise_search::WhiteNoiseSearch;
use crate::estimate::result::Calibration;
use crate::estimate::settings::CalibrationSettings;
use crate::sensor::SensorKind;

/// Calibrates an IMU.
///
/// # Errors
/// - [`Error::Recording`](crate::Error::Recording): a sensor's recording is missing or unusable, the sensors do not overlap in time, or the gyroscope's readings
///   cannot be angular rates in the given unit.
/// - [`Error::Experiment`](crate::Error::Experiment): the readings contradict given directions or values.
/// - [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) names the parameters that holds or rotations do not determine, and a remedy.
pub fn calibrate_imu(problem: &ImuProblem<'_>, settings: &CalibrationSettings) -> Result<Calibration> {
    calibrate_imu_with(problem, settings, &WhiteNoiseSearch::known(problem.setup.white_noise))
}

/// Calibrates an IMU, with a search for the gyroscope's white noise that runs beside the fit of the accelerometer.
///
/// The result of the search replaces [`ImuSetup::white_noise`]. Spikes and invalid samples are removed first
/// ([`ImuRecording::without_spikes`](crate::sensor::ImuRecording::without_spikes)), with warnings. This is not done if the holds are given
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
    // rotations separate what the holds alone do not
    let warnings = std::mem::take(&mut calibration.warnings);
    calibration.warnings = warnings
        .into_iter()
        .filter(|warning| {
            // its subject is the list of the parameters
            let parameters =
                || warning.subject().unwrap_or_default().split(", ").map(str::to_owned).collect();
            warning.code() != HoldsSpreadLittle::CODE
                || are_correlated(&calibration, &parameters() as &Vec<String>)
        })
        .collect();
    Ok(calibration)
}

/// Removes outliers from the recording, then calibrates.
fn without_outliers(
    problem: &ImuProblem<'_>,
    settings: &CalibrationSettings,
    white_noise: &WhiteNoiseSearch<'_>,
) -> Result<Calibration> {
    let (recording, mut outliers) = problem.recording.without_spikes();
    let mut outcome = of_clean(&ImuProblem { recording: &recording, ..*problem }, settings, white_noise);
    let mut note = None;
    if let Some((gyroscope, samples, at_rest)) = problem.recording.gyroscope_with_knocks() {
        let recording = recording.into_owned().with(SensorKind::Gyroscope, Some(gyroscope));
        let kept = of_clean(&ImuProblem { recording: &recording, ..*problem }, settings, white_noise);
        if let Ok(found) = &kept
            && let Some(better) = KnocksKept::of(outcome.as_ref().ok(), found, samples)
        {
            outliers.retain(|(sensor_kind, _)| *sensor_kind == SensorKind::Accelerometer);
            outliers.extend(at_rest.map(|at_rest| (SensorKind::Gyroscope, at_rest)));
            (outcome, note) = (kept, Some(Diagnostic::from(better)));
        }
    }
    let mut calibration = outcome?;
    let found = outliers.iter().filter_map(|(sensor_kind, outliers)| {
        let unit = problem.recording.sensor(*sensor_kind)?.unit;
        Some(samples::Spikes::of(outliers, *sensor_kind, unit).into())
    });
    calibration.warnings.splice(0..0, found.chain(note));
    Ok(calibration)
}

/// Calibrates from a recording without outliers.
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
    let contradictions = contradictions(problem, settings, white_noise);
    let absurd = contradictions.iter().any(|term| term.is_absurd);
    let stated = contradictions.into_iter().map(|term| term.known);
    match outcome {
        Ok(mut found) if !absurd => {
            found.warnings.splice(0..0, stated.map(Diagnostic::from));
            Ok(found)
        }
        Err(error) if stated.len() == 0 => Err(error),
        _ => Err(Error::experiment(InputError::new(
            Refusal::KnownContradicted,
            stated.map(|known| known.finding()).collect::<Vec<_>>().join("; "),
            "correct the value in [known], its unit too, or leave it out and let the recording tell",
        ))),
    }
}

/// The given terms that the recording contradicts by far, from the fit without any of them.
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
