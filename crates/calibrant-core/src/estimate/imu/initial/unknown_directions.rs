//! The accelerometer from holds of unknown directions: its static calibration.

use crate::diagnostic::Diagnostic;
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::holds::{self, HoldsSetup, holds_lost_to_filter, with_filter};
use crate::estimate::imu::checks::swapped_sensors::with_swapped_sensors;
use crate::estimate::imu::initial::accelerometer::InitialAccelerometer;
use crate::estimate::imu::initial::face_repeats::FaceRepeats;
use crate::estimate::imu::known_term::KnownTerm;
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::stationary::intervals::find_clean_imu_holds;
use crate::estimate::problem::{CalibrationProblem, Stimulus};
use crate::estimate::quantisation::{coarse_axes_in, of_means};
use crate::estimate::result::Recovered;
use crate::estimate::settings::CalibrationSettings;
use crate::sensor::{ImuQuantity, Recording, SensorKind, SensorThermal};
use nalgebra::Vector3;
use std::borrow::Cow;

/// The initial accelerometer from its static calibration.
pub(crate) fn from_unknown_directions(
    problem: &ImuProblem<'_>,
    recording: &Recording,
    settings: &CalibrationSettings,
    intervals_s: Option<Vec<(f64, f64)>>,
) -> Result<InitialAccelerometer> {
    let detected = intervals_s.is_none();
    let minimum_s = problem.setup.holds.minimum_hold_s;
    let found = match (&problem.setup.holds.found, detected) {
        (_, false) => Cow::Borrowed(&[][..]),
        (Some(found), true) => Cow::Borrowed(found.as_slice()),
        (None, true) => Cow::Owned(find_clean_imu_holds(problem.recording, minimum_s)?),
    };
    let intervals_s =
        intervals_s.unwrap_or_else(|| found.iter().map(|hold| (hold.start_s, hold.end_s)).collect());
    let mut setup = HoldsSetup { intervals_s: Some(intervals_s), ..problem.setup.holds.clone() };
    // temperature terms follow a drift, and a bias of each recording, by themselves
    if !problem.setup.thermal.is_none() {
        setup.bias_drift_sd_mps2 = 0.0;
        setup.further_from_s.clear();
    }
    let stimulus = Stimulus::Holds(&setup);
    let as_read = problem.recording[SensorKind::Accelerometer].as_ref().unwrap_or(recording);
    let alone = CalibrationProblem { sensor: problem.accelerometer, recording, stimulus };
    let mut found_alone = holds::calibrate(&alone, &setup, settings, as_read);
    let of_accelerometer =
        |known: &&KnownTerm| matches!(known.quantity, ImuQuantity::Of(SensorKind::Accelerometer, _));
    let known: Vec<KnownTerm> = problem.setup.known_terms().filter(of_accelerometer).copied().collect();
    if matches!(found_alone, Err(Error::NotIdentifiable(_))) && !known.is_empty() {
        let with_known = HoldsSetup { known, ..setup.clone() };
        let stimulus = Stimulus::Holds(&with_known);
        let alone = CalibrationProblem { stimulus, ..alone };
        found_alone = match holds::calibrate(&alone, &with_known, settings, as_read) {
            Err(Error::NotIdentifiable(_)) => found_alone,
            found => found,
        };
    }
    let mut first = found_alone.map_err(|error| match detected {
        true => {
            let error = with_filter(error, as_read, &found, minimum_s);
            with_swapped_sensors(error, problem.recording, minimum_s)
        }
        false => error,
    })?;
    if detected {
        let lost = holds_lost_to_filter(as_read, &found, minimum_s);
        first.warnings.extend(lost.map(Diagnostic::from));
    }
    let Recovered::Holds(mut holds) = first.recovered else {
        return Err(Error::experiment(InputError::new(
            Refusal::ExperimentUnsuited,
            "an IMU is calibrated from holds",
            "use [holds]",
        )));
    };
    holds.detected = detected;
    let within = first.fit.noise_estimate.unwrap_or_else(Vector3::zeros);
    let sound = holds.holds.iter().filter(|result| result.reason.is_none());
    let of_mean = of_means(&coarse_axes_in(as_read, sound.map(|result| &result.hold)));
    let (thermal, adjusted) = (SensorThermal::default(), None);
    let warnings = first.warnings;
    Ok(InitialAccelerometer {
        sensor: first.imu[SensorKind::Accelerometer],
        within,
        of_mean,
        holds,
        alignment: None,
        repeats: FaceRepeats::default(),
        warnings,
        thermal,
        adjusted,
    })
}
