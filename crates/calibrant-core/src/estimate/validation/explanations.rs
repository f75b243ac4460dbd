//! Why errors may be larger than predicted although the covariance is right: something is another than at the calibration.
//!
//! An accelerometer whose bias has moved by `δ` (as a specific force) misses gravity in a hold with the direction `u` by `u·δ`, one whose gains have changed by the shares `γ` by `g Σ_i u_i² γ_i`.
//! Where either, fitted by generalised least squares, leaves errors as they were predicted, it is a likely reason, and the better one of both is told; where neither does, both together. So are a gyroscope's gains that have changed by
//! shares `γ`: then each of its axes reads `1 + γ_i` times as much of what it feels, and the errors of rotations change as they do with the rows of its matrix. Angular rates in another unit
//! than the stated one carry gravity rightly once they are converted.

use super::chi_square_ratio::Ratio;
use super::covariance_verdict::CovarianceVerdict;
use super::predicted_error::Group;
use super::prediction::Prediction;
use super::prediction_errors::{Errors, Unused};
use super::result::Validation;
use super::statistics::{Degrees, degrees_behind};
use super::unused_error::ErrorKind;
use super::whitened_errors::{Shift, Whitened};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::samples::CalibrationExtrapolated;
use crate::diagnostic::validation::{
    AccelerometerMoved, AngularUnitWrong, GyroscopeGainsMoved, TemperatureDiffers,
};
use crate::estimate::Calibration;
use crate::estimate::holds::median;
use crate::sensor::{ImuQuantity, ImuRecording, Quantity, ReadingUnit, Recording, SensorKind};
use nalgebra::{DMatrix, Vector3};

/// So many more errors than numbers that are fitted to them.
const ENOUGH: usize = 3;
/// In the right unit errors of rotations are smaller by this factor at least.
const FAR_SMALLER: f64 = 0.1;
/// Mean temperatures that are closer explain little, K.
const SAME_K: f64 = 3.0;

/// A difference of temperature, where a calibration without temperature terms was tried on another recording: both have temperatures, and something is not as predicted.
#[must_use]
pub fn other_temperature(
    calibration: &Calibration,
    validation: &Validation,
    calibrated: &ImuRecording,
    here: &ImuRecording,
) -> Option<Diagnostic> {
    if calibration.holds().is_some_and(|holds| holds.temperatures_c.is_some()) || !is_wrong(validation) {
        return None;
    }
    let mean = |recording: &ImuRecording| {
        let values = recording.temperature_c.as_deref().filter(|values| !values.is_empty())?;
        Some(values.iter().sum::<f64>() / values.len() as f64)
    };
    let (calibrated_mean_c, mean_c) = (mean(calibrated)?, mean(here)?);
    ((mean_c - calibrated_mean_c).abs() >= SAME_K)
        .then(|| TemperatureDiffers { calibrated_mean_c, mean_c }.into())
}

/// Is anything not as predicted?
fn is_wrong(validation: &Validation) -> bool {
    validation.kinds.iter().any(|errors| errors.verdict == CovarianceVerdict::TooSmall)
        || validation.bias_shift.is_some_and(|shift| shift.moved)
}

/// Temperatures beyond those of the calibration, where it follows them and something is not as predicted.
fn beyond_temperatures(
    validation: &Validation,
    prediction: &Prediction,
    unused: &Unused<'_>,
) -> Option<Diagnostic> {
    let here_c = unused.temperatures.filter(|_| is_wrong(validation))?.range_c()?;
    CalibrationExtrapolated::of(&prediction.imu.thermal, here_c).map(Diagnostic::from)
}

/// What explains the errors of a recording that are larger than predicted.
pub(super) fn likely_explanations(
    validation: &Validation,
    prediction: &Prediction,
    unused: &Unused<'_>,
) -> Vec<Diagnostic> {
    let small = |kind: ErrorKind| {
        validation.of_kind(kind).is_some_and(|errors| errors.verdict == CovarianceVerdict::TooSmall)
    };
    let (magnitude, rotation) = (small(ErrorKind::Magnitude), small(ErrorKind::Rotation));
    if let Some(beyond) = beyond_temperatures(validation, prediction, unused) {
        return vec![beyond];
    }
    if !magnitude && !rotation {
        return Vec::new();
    }
    let Some(errors) = unused.errors(prediction) else { return Vec::new() };
    let of_accelerometer = magnitude.then(|| accelerometer_moved(&errors, prediction)).flatten();
    let of_unit = rotation.then(|| angular_unit(&errors, prediction, unused)).flatten();
    let of_gains = (rotation && of_unit.is_none()).then(|| gyroscope_gains(&errors, prediction)).flatten();
    of_accelerometer.into_iter().chain(of_unit).chain(of_gains).collect()
}

/// Numbers that leave errors as they were predicted: χ² over its degrees of freedom that is left, and the numbers. `by`: how each error changes with them.
fn explaining(group: &Group, scatter: Degrees, by: &dyn Fn(usize) -> DMatrix<f64>) -> Option<(f64, Shift)> {
    let count: usize = group.items.iter().map(|item| item.error.len()).sum();
    let left = count.checked_sub(by(0).ncols()).filter(|left| *left >= ENOUGH)?;
    let (low, high) = Ratio::new(left as f64, &degrees_behind(group.items.iter(), &[scatter])).usual(1);
    let whitened = Whitened::about(group, &vec![true; group.items.len()], by)?;
    let shift = whitened.shift()?;
    let rest = (whitened.chi2()? - shift.chi2).max(0.0) / left as f64;
    let verdict = CovarianceVerdict::of(rest.sqrt(), ((rest / high).sqrt(), (rest / low).sqrt()));
    (verdict != CovarianceVerdict::TooSmall).then_some((rest, shift))
}

fn gyroscope_gains(errors: &Errors, prediction: &Prediction) -> Option<Diagnostic> {
    // what the estimates lack of the truth, for each share
    let mut lacking = DMatrix::zeros(prediction.quantities.len(), 3);
    for (k, quantity) in prediction.quantities.iter().enumerate() {
        let ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Scale(row) | Quantity::CrossAxis(row, _)) =
            quantity
        else {
            continue;
        };
        lacking[(k, row.index())] = -quantity.value(&prediction.imu);
    }
    let by = |k: usize| &errors.rotations.items[k].by_parameters * &lacking;
    let (_, shift) = explaining(&errors.rotations, prediction.rotation_degrees, &by)?;
    Some(GyroscopeGainsMoved { change: shift.three(0), change_sd: shift.sd_of_three(0) }.into())
}

fn accelerometer_moved(errors: &Errors, prediction: &Prediction) -> Option<Diagnostic> {
    let squares = |along: &Vector3<f64>| along.component_mul(along) * prediction.gravity_mps2;
    let about = |row: &dyn Fn(&Vector3<f64>) -> Vec<f64>| {
        let by = |k: usize| {
            let row = row(&errors.magnitudes.items[k].place.along[0]);
            DMatrix::from_row_slice(1, row.len(), &row)
        };
        explaining(&errors.magnitudes, prediction.holds_degrees, &by)
    };
    let bias = about(&|along| along.as_slice().to_vec());
    let gain = about(&|along| squares(along).as_slice().to_vec());
    let is_bias = match (&bias, &gain) {
        (Some((of_bias, _)), Some((of_gain, _))) => of_bias <= of_gain,
        (bias, _) => bias.is_some(),
    };
    let (shift, place_of_bias, place_of_gain) = match if is_bias { bias } else { gain } {
        Some((_, shift)) => (shift, is_bias.then_some(0), (!is_bias).then_some(0)),
        None => {
            let (_, both) = about(&|along| [along.as_slice(), squares(along).as_slice()].concat())?;
            (both, Some(0), Some(3))
        }
    };
    let three = |place: Option<usize>| place.map(|place| shift.three(place));
    let sd_of_three = |place: Option<usize>| place.map(|place| shift.sd_of_three(place));
    let moved = AccelerometerMoved {
        shift_mps2: three(place_of_bias),
        shift_sd_mps2: sd_of_three(place_of_bias),
        change: three(place_of_gain),
        change_sd: sd_of_three(place_of_gain),
    };
    Some(moved.into())
}

fn angular_unit(errors: &Errors, prediction: &Prediction, unused: &Unused<'_>) -> Option<Diagnostic> {
    let gyroscope = unused.gyroscope.filter(|gyroscope| gyroscope.unit == ReadingUnit::RadianPerSecond)?;
    let missed = |errors: &Errors| {
        let items = &errors.rotations.items;
        (!items.is_empty()).then(|| median(items.iter().map(|item| item.error.norm()).collect()))
    };
    let now = missed(errors)?;
    let degree = 1.0_f64.to_radians();
    [degree, degree.recip()].into_iter().find_map(|factor| {
        let readings = gyroscope.readings.iter().map(|y| y * factor).collect();
        let converted = Recording { readings, ..gyroscope.clone() };
        let unused = Unused { gyroscope: Some(&converted), ..unused.clone() };
        let missed = missed(&unused.errors(prediction)?)?;
        (missed < FAR_SMALLER * now).then(|| AngularUnitWrong { factor }.into())
    })
}
