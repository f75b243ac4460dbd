//! Tries a calibration on another recording of its sensor.

use super::caveats_of_calibration::Caveats;
use super::explanations;
use super::inputs::{at_least_one, from_holds, of_holds, singular, temperatures, view, with_gyroscope};
use super::judgement::judged;
use super::prediction::Prediction;
use super::prediction_errors::{Errors, Unused};
use super::result::{Validation, ValidationSource};
use super::scatter_comparison;
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::holds::median;
use crate::estimate::imu::recordings;
use crate::estimate::{
    Calibration, CalibrationProblem, ImuProblem, ImuSetup, find_holds, find_imu_holds, holds_between,
};
use crate::sensor::SensorKind;

/// A magnitude this far from gravity on half of the holds is not that of the sensor that was calibrated.
const ANOTHER_SENSOR: f64 = 0.1;

/// A magnitude is off by g, or by 1/g, within this share: a bias changes it where the readings are a tenth of what they should be.
const OTHER_UNIT: f64 = 0.25;

/// Tries the calibration of an IMU on another recording of it.
///
/// `problem` is that of the other recording: its holds are found (or given) as the setup says.
///
/// # Errors
/// [`Error::Recording`](crate::Error::Recording) where the recording has no holds, lacks a sensor, is in other units, or is not one of this IMU.
pub fn validate_imu(calibration: &Calibration, problem: &ImuProblem<'_>) -> Result<Validation> {
    let (accelerometer, gyroscope) = recordings(problem)?;
    let setup = &problem.setup.holds;
    let holds = match (&setup.intervals_s, &setup.found) {
        (Some(intervals), _) => holds_between(accelerometer, intervals)?,
        (None, Some(found)) => found.clone(),
        (None, None) => find_imu_holds(problem.recording, setup.minimum_hold_s)?,
    };
    let holds = at_least_one(holds, setup)?;
    let at_sensor = temperatures(calibration, problem)?;
    let unused = Unused {
        gyroscope: Some(gyroscope),
        temperatures: at_sensor.as_ref().map(view),
        ..Unused::of_accelerometer(accelerometer, &holds)
    };
    with_gyroscope(&holds, gyroscope)?;
    let prediction = Prediction::of(calibration, from_holds(calibration)?, problem.setup);
    on_another(&prediction, unused, &Caveats::of(calibration))
}

/// Tries the calibration of an accelerometer from holds on another recording of it.
///
/// # Errors
/// As [`validate_imu`]; [`Error::Experiment`](crate::Error::Experiment) for a calibration that is not from holds.
pub fn validate(calibration: &Calibration, problem: &CalibrationProblem<'_>) -> Result<Validation> {
    let (setup, found) = of_holds(calibration, problem)?;
    problem.validate()?;
    let holds = match (&setup.intervals_s, &setup.found) {
        (Some(intervals), _) => holds_between(problem.recording, intervals)?,
        (None, Some(found)) => found.clone(),
        (None, None) => find_holds(problem.recording, setup.minimum_hold_s)?,
    };
    let holds = at_least_one(holds, setup)?;
    let prediction = Prediction::of(calibration, found, &ImuSetup::from_holds(setup));
    let unused = Unused::of_accelerometer(problem.recording, &holds);
    on_another(&prediction, unused, &Caveats::of(calibration))
}

pub(super) fn on_another(
    prediction: &Prediction,
    unused: Unused<'_>,
    caveats: &Caveats,
) -> Result<Validation> {
    let unused = Unused { another: true, ..unused };
    if unused.holds.is_empty() {
        return Err(Error::recording(InputError::new(
            Refusal::ReadingsSaturated,
            "the accelerometer saturates in each of its holds",
            "record with a larger range",
        )));
    }
    let mut errors = unused.errors(prediction).ok_or_else(singular)?;
    let open = scatter_comparison::as_shown(prediction, &errors);
    let prediction = open.as_ref().unwrap_or(prediction);
    if open.is_some() {
        errors = unused.errors(prediction).ok_or_else(singular)?;
    }
    let median = median(errors.magnitudes.items.iter().map(|item| item.error[0].abs()).collect());
    if median > ANOTHER_SENSOR * prediction.gravity_mps2 {
        return Err(Error::recording(InputError::new(
            Refusal::CalibrationUnsuited,
            format!("with this calibration, its holds miss the magnitude of gravity by {median:.2} m/s²"),
            other_unit(&errors, prediction)
                .unwrap_or("is it a recording of the same sensor, in the same units?"),
        )));
    }
    let source = ValidationSource::Recording { name: String::new() };
    let mut validation = judged(source, vec![errors], prediction, 0.0, caveats);
    for noise in &mut validation.noise {
        let recording = match noise.sensor_kind {
            SensorKind::Accelerometer => Some(unused.accelerometer),
            SensorKind::Gyroscope => unused.gyroscope,
        };
        let holds = unused.holds.iter().map(|(_, hold)| *hold);
        *noise = recording.map_or(*noise, |recording| noise.with_steps(recording, holds));
    }
    validation.likely_explanations = explanations::likely_explanations(&validation, prediction, &unused);
    Ok(validation)
}

/// What to ask where magnitudes are off by g or by 1/g: readings in g taken for m/s², or the other way round.
fn other_unit(errors: &Errors, prediction: &Prediction) -> Option<&'static str> {
    let magnitudes = errors.magnitudes.items.iter().map(|item| item.error[0] + prediction.gravity_mps2);
    let ratio = median(magnitudes.collect()) / prediction.gravity_mps2;
    let near = |expected: f64| (ratio / expected).ln().abs() < OTHER_UNIT;
    if near(1.0 / prediction.gravity_mps2) {
        Some("they are 9.8 times too small: are the readings in g, and stated to be in m/s²?")
    } else if near(prediction.gravity_mps2) {
        Some("they are 9.8 times too large: are the readings in m/s², and stated to be in g?")
    } else {
        None
    }
}
