//! What a validation begins with: holds, temperatures, and a calibration that corrects something.

use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::{at_sensor, needed_temperatures};
use crate::estimate::{Calibration, CalibrationProblem, HoldCalibration, HoldsSetup, ImuProblem, Stimulus};
use crate::motion::Hold;
use crate::sensor::{Recording, Temperatures};

/// The temperatures of the sensor in a recording, where the calibration follows them: sample times, and values in °C with the thermometer's lag taken off.
pub(super) fn temperatures<'a>(
    calibration: &Calibration,
    problem: &ImuProblem<'a>,
) -> Result<Option<(&'a [f64], Vec<f64>)>> {
    let holds = from_holds(calibration)?;
    if holds.temperatures_c.is_none() {
        return Ok(None);
    }
    let shown = needed_temperatures(problem.recording)?;
    let lag_s = holds.thermometer.map_or(problem.setup.thermometer.lag_s, |lag| lag.lag_s);
    Ok(Some((shown.times_s, at_sensor(&shown, lag_s))))
}

/// A view of them.
pub(super) fn view<'a>((times_s, values_c): &'a (&'a [f64], Vec<f64>)) -> Temperatures<'a> {
    Temperatures { times_s, values_c }
}

/// The holds, of which there are some.
pub(super) fn at_least_one(holds: Vec<Hold>, setup: &HoldsSetup) -> Result<Vec<Hold>> {
    if holds.is_empty() {
        return Err(Error::recording(InputError::new(
            Refusal::HoldsMissing,
            format!("it has no holds of at least {} s", setup.minimum_hold_s),
            "a validation needs the sensor held still in several orientations",
        )));
    }
    Ok(holds)
}

/// Refuses holds of which none has samples of the gyroscope.
pub(super) fn with_gyroscope(holds: &[Hold], gyroscope: &Recording) -> Result<()> {
    if holds.iter().all(|hold| gyroscope.between(hold.start_s, hold.end_s).len() < 2) {
        return Err(Error::recording(InputError::new(
            Refusal::RecordingsUnlike,
            "the gyroscope has no samples in the holds of the accelerometer",
            "both need the same clock: are these files of one recording?",
        )));
    }
    Ok(())
}

/// What a calibration found of its holds.
pub(super) fn from_holds(calibration: &Calibration) -> Result<&HoldCalibration> {
    calibration.holds().ok_or_else(without_holds)
}

/// How holds are to be treated, and what a calibration found of them.
pub(super) fn of_holds<'a>(
    calibration: &'a Calibration,
    problem: &CalibrationProblem<'a>,
) -> Result<(&'a HoldsSetup, &'a HoldCalibration)> {
    match problem.stimulus {
        Stimulus::Holds(setup) => Ok((setup, from_holds(calibration)?)),
        Stimulus::Motion(_) => Err(without_holds()),
    }
}

fn without_holds() -> Error {
    Error::experiment(InputError::new(
        Refusal::ValidationImpossible,
        "only a calibration from holds can be validated: a commanded motion gives no errors of which anything is known",
        "record the sensor held still in several orientations, and use [holds]",
    ))
}

pub(super) fn singular() -> Error {
    Error::recording(InputError::new(
        Refusal::CalibrationUnusable,
        "the calibration has a singular matrix, so that it corrects nothing",
        "calibrate again",
    ))
}
