//! A calibration on data that were not used for it: is its covariance to be believed?
//!
//! Three kinds of errors are known without any reference: the corrected magnitude in a hold less gravity, the corrected rate in it, and gravity carried by the
//! gyroscope to the next hold less gravity found there. For each, the calibration predicts a covariance
//!
//! ```text
//! C = D + J Σ Jᵀ
//! ```
//!
//! `Σ` that of the parameters (which all errors have in common), `D` of noise and of the scatter between holds or rotations that the calibration found.
//! `eᵀ C⁻¹ e` over its degrees of freedom is then about 1 if all of that is right; its root is the factor by which the standard deviations are off.
//!
//! Gravity is taken to be the one of the calibration, so that its uncertainty moves corrected and true magnitude alike and counts for neither. The bias of a
//! gyroscope may differ each time it is switched on: in another recording it is compared first, and where it has moved the rest is judged with the bias it has moved to.
//!
//! # Folds
//! The errors of all blocks are pooled, each with the covariance of the calibration without it. These calibrations share data, so the errors of different blocks are
//! correlated and the distribution of the pooled χ² is approximate (`bengio2004`); its mean is right.
//!
//! # References
//! `viechtbauer2007`, `bengio2004`

mod claim;
mod cross;
mod doubt;
mod folds;
mod held;
mod item;
mod noise;
mod predict;
mod ratio;
mod reason;
mod reordered;
mod result;
mod same;
mod scatter;
mod smoothed;
mod statistics;
mod whitened;

pub use cross::{cross_validate, cross_validate_imu};
pub use doubt::Doubt;
pub use noise::{CoarseStep, NoiseRatio};
pub use reason::{LikelyReason, other_temperature};
pub use reordered::readings_in_common;
pub use result::*;
pub use same::noise_in_common;

use super::holds::median;
use super::imu::{needed_temperatures, recordings};
use super::{
    Calibration, CalibrationProblem, HoldCalibration, HoldsSetup, ImuCalibration, ImuProblem, Recovered,
    Stimulus, find_holds, find_imu_holds, holds_between,
};
use crate::error::{Complaint, Error, Result};
use crate::motion::Hold;
use crate::sensor::{Temperatures, Triad};
use claim::Claim;
use doubt::Doubts;
use item::Group;
use predict::{Errors, Unused};
use statistics::{Behind, Degrees, judge};

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
pub fn validate_imu(calibration: &ImuCalibration, problem: &ImuProblem<'_>) -> Result<Validation> {
    let (accelerometer, gyroscope) = recordings(problem)?;
    let setup = &problem.setup.holds;
    let holds = match &setup.intervals_s {
        Some(intervals) => holds_between(accelerometer, intervals)?,
        None => find_imu_holds(problem.recording, setup.minimum_hold_s)?,
    };
    let holds = at_least_one(holds, setup)?;
    let unused = Unused {
        gyroscope: Some(gyroscope),
        temperatures: temperatures(calibration, problem)?,
        ..Unused::of_accelerometer(accelerometer, &holds)
    };
    if holds.iter().all(|hold| gyroscope.between(hold.start_s, hold.end_s).len() < 2) {
        return Err(Error::recording(Complaint::new(
            "the gyroscope has no samples in the holds of the accelerometer",
            "both need the same clock: are these files of one recording?",
        )));
    }
    let claim = Claim::of_imu(calibration, problem.setup);
    on_another(&claim, unused, &Doubts::of_imu(calibration))
}

/// Tries the calibration of an accelerometer from holds on another recording of it.
///
/// # Errors
/// As [`validate_imu`]; [`Error::Experiment`](crate::Error::Experiment) for a calibration that is not from holds.
pub fn validate(calibration: &Calibration, problem: &CalibrationProblem<'_>) -> Result<Validation> {
    let (setup, found) = of_holds(calibration, problem)?;
    problem.validate()?;
    let holds = match &setup.intervals_s {
        Some(intervals) => holds_between(problem.recording, intervals)?,
        None => find_holds(problem.recording, setup.minimum_hold_s)?,
    };
    let holds = at_least_one(holds, setup)?;
    let list = setup.gauge.parameter_list(problem.sensor.model);
    let claim = Claim::of_accelerometer(calibration, found, &list, &setup.gravity);
    let unused = Unused::of_accelerometer(problem.recording, &holds);
    on_another(&claim, unused, &Doubts::of_holds(found))
}

/// The temperatures of a recording, where the calibration follows them.
fn temperatures<'a>(
    calibration: &ImuCalibration,
    problem: &ImuProblem<'a>,
) -> Result<Option<Temperatures<'a>>> {
    calibration.hold_temperatures_c.as_ref().map(|_| needed_temperatures(problem.recording)).transpose()
}

fn on_another(claim: &Claim, unused: Unused<'_>, doubts: &Doubts) -> Result<Validation> {
    let unused = Unused { another: true, ..unused };
    if unused.holds.is_empty() {
        return Err(Error::recording(Complaint::new(
            "the accelerometer saturates in each of its holds",
            "record with a larger range",
        )));
    }
    let mut errors = unused.errors(claim).ok_or_else(singular)?;
    let open = scatter::as_shown(claim, &errors);
    let claim = open.as_ref().unwrap_or(claim);
    if open.is_some() {
        errors = unused.errors(claim).ok_or_else(singular)?;
    }
    let median = median(errors.magnitudes.items.iter().map(|item| item.error[0].abs()).collect());
    if median > ANOTHER_SENSOR * claim.gravity_mps2 {
        return Err(Error::recording(Complaint::new(
            format!("with this calibration, its holds miss the magnitude of gravity by {median:.2} m/s²"),
            other_unit(&errors, claim).unwrap_or("is it a recording of the same sensor, in the same units?"),
        )));
    }
    let source = ValidationSource::Recording { name: String::new() };
    let mut validation = judged(source, vec![errors], claim, doubts);
    for noise in &mut validation.noise {
        let recording = match noise.triad {
            Triad::Accelerometer => Some(unused.accelerometer),
            Triad::Gyroscope => unused.gyroscope,
        };
        let holds = unused.holds.iter().map(|(_, hold)| *hold);
        *noise = recording.map_or(*noise, |recording| noise.with_steps(recording, holds));
    }
    validation.reasons = reason::reasons(&validation, claim, &unused);
    Ok(validation)
}

/// What to ask where magnitudes are off by g or by 1/g: readings in g taken for m/s², or the other way round.
fn other_unit(errors: &Errors, claim: &Claim) -> Option<&'static str> {
    let magnitudes = errors.magnitudes.items.iter().map(|item| item.error[0] + claim.gravity_mps2);
    let ratio = median(magnitudes.collect()) / claim.gravity_mps2;
    let near = |expected: f64| (ratio / expected).ln().abs() < OTHER_UNIT;
    if near(1.0 / claim.gravity_mps2) {
        Some("they are 9.8 times too small: are the readings in g, and stated to be in m/s²?")
    } else if near(claim.gravity_mps2) {
        Some("they are 9.8 times too large: are the readings in m/s², and stated to be in g?")
    } else {
        None
    }
}

/// The holds, of which there are some.
fn at_least_one(holds: Vec<Hold>, setup: &HoldsSetup) -> Result<Vec<Hold>> {
    if holds.is_empty() {
        return Err(Error::recording(Complaint::new(
            format!("it has no holds of at least {} s", setup.minimum_hold_s),
            "a validation needs the sensor held still in several orientations",
        )));
    }
    Ok(holds)
}

/// How holds are to be treated, and what a calibration found of them.
fn of_holds<'a>(
    calibration: &'a Calibration,
    problem: &CalibrationProblem<'a>,
) -> Result<(&'a HoldsSetup, &'a HoldCalibration)> {
    match (&problem.stimulus, &calibration.recovered) {
        (Stimulus::Holds(setup), Recovered::Holds(found)) => Ok((setup, found)),
        _ => Err(Error::experiment(Complaint::new(
            "only a calibration from holds can be validated: a commanded motion gives no errors of which anything is known",
            "record the sensor held still in several orientations, and use [holds]",
        ))),
    }
}

fn singular() -> Error {
    Error::recording(Complaint::new(
        "the calibration has a singular matrix, so that it corrects nothing",
        "calibrate again",
    ))
}

/// The errors of one or more claims, those of the last of which tells how much is behind the scatter that was estimated.
fn judged(source: ValidationSource, errors: Vec<Errors>, claim: &Claim, doubts: &Doubts) -> Validation {
    let (bias_shift, noise) = match errors.as_slice() {
        [one] => (one.shift, one.noise.clone()),
        _ => (None, Vec::new()),
    };
    let (mut magnitudes, mut rates, mut rotations): (Vec<Group>, Vec<Group>, Vec<Group>) = Default::default();
    for errors in errors {
        magnitudes.push(errors.magnitudes);
        rates.push(errors.rates);
        rotations.push(errors.rotations);
    }
    let folds = matches!(source, ValidationSource::Folds { .. });
    let behind = |of: &[Degrees]| Behind { scatter_degrees: of.to_vec(), folds, free_shift: false, doubts };
    let of_rates =
        Behind { free_shift: bias_shift.is_some_and(|shift| shift.moved), ..behind(&claim.still_degrees) };
    let kinds = [
        judge(ErrorKind::Magnitude, &magnitudes, &behind(&[claim.holds_degrees])),
        judge(ErrorKind::Rate, &rates, &of_rates),
        judge(ErrorKind::Rotation, &rotations, &behind(&[claim.rotation_degrees])),
    ];
    Validation {
        source,
        kinds: kinds.into_iter().flatten().collect(),
        bias_shift,
        noise,
        reasons: Vec::new(),
    }
}
