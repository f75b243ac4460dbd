//! Writes `calibration.json` of a whole IMU: calibrant JSON of schema 2, and the further results of the
//! estimator. Every reader of calibrations takes it.

use super::calibration::Input;
use super::convention::{Heading, ImuCore};
use super::diagnostics::{DiagnosticFields, DiagnosticWords};
use super::holds::HoldsFields;
use super::json;
use super::shared_fields::{InUnit, matrix_rows, per_axis};
use super::validation::{ValidationFields, validation_fields};
use calibrant_core::error::Result;
use calibrant_core::estimate::{ImuCalibration, RotationResult, TurnResult, Validation};
use serde::Serialize;
use std::path::Path;

/// Writes `calibration.json` of a whole IMU, which [`read_calibrated_imu`](super::read_calibrated_imu) reads.
///
/// The same calibration gives the same bytes. Angles are in rad; of a rotation that could not be integrated
/// they are `null`. Holds of a rotation are indices into the table of holds, from 0. `validations` are the
/// errors on data that the calibration did not use. `inputs` has one entry for each file of the recording.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_imu_calibration(
    path: &Path,
    calibration: &ImuCalibration,
    validations: &[Validation],
    inputs: &[Input],
    words: &DiagnosticWords<'_>,
) -> Result<()> {
    json::write_json(path, &ImuCalibrationFile::of(calibration, validations, inputs, words))
}

/// The text that [`write_imu_calibration`] writes.
#[must_use]
pub fn imu_calibration_json(
    calibration: &ImuCalibration,
    validations: &[Validation],
    inputs: &[Input],
    words: &DiagnosticWords<'_>,
) -> String {
    json::to_json(&ImuCalibrationFile::of(calibration, validations, inputs, words))
}

#[derive(Serialize)]
struct ImuCalibrationFile<'a> {
    #[serde(flatten)]
    heading: Heading,
    status: &'static str,
    iterations: usize,
    gradient_norm: f64,
    #[serde(flatten)]
    core: ImuCore,
    correlation: Vec<Vec<f64>>,
    fit: FitFields,
    holds: HoldsFields,
    still_gyroscope: StillFields<'a>,
    rotations: RotationsFields<'a>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    turns: Vec<TurnFields>,
    #[serde(skip_serializing_if = "Option::is_none")]
    validation: Option<ValidationFields>,
    warnings: Vec<DiagnosticFields>,
}

#[derive(Serialize)]
struct FitFields {
    chi2: f64,
    degrees_of_freedom: usize,
}

impl<'a> ImuCalibrationFile<'a> {
    fn of(
        calibration: &'a ImuCalibration,
        validations: &[Validation],
        inputs: &[Input],
        words: &DiagnosticWords<'_>,
    ) -> Self {
        Self {
            heading: Heading::new(),
            status: calibration.status.name(),
            iterations: calibration.iterations,
            gradient_norm: calibration.gradient_norm,
            core: ImuCore::of(&calibration.calibrated(), inputs).with_prior_share(&calibration.prior_share),
            correlation: matrix_rows(&calibration.correlation()),
            fit: FitFields { chi2: calibration.chi2, degrees_of_freedom: calibration.degrees_of_freedom },
            holds: HoldsFields::of(&calibration.holds, calibration.accelerometer_unit)
                .at_latitude(calibration.latitude_deg),
            still_gyroscope: StillFields::of(calibration),
            rotations: RotationsFields::of(calibration),
            turns: calibration.turns.iter().map(TurnFields::of).collect(),
            validation: validation_fields(validations),
            warnings: DiagnosticFields::all(&calibration.warnings, words),
        }
    }
}

/// The gyroscope in the holds.
#[derive(Serialize)]
struct StillFields<'a> {
    #[serde(flatten)]
    noise: InUnit<Vec<f64>>,
    noise_source: String,
    #[serde(flatten)]
    between_holds_sd: InUnit<Vec<f64>>,
    rate_rms_radps: f64,
    rate_rms_before_radps: f64,
    before: &'a str,
}

impl<'a> StillFields<'a> {
    fn of(calibration: &'a ImuCalibration) -> Self {
        let (still, unit) = (&calibration.still, calibration.gyroscope_unit);
        Self {
            noise: InUnit::new("noise_per_sample", unit, per_axis(&still.noise, 3)),
            noise_source: still.noise_source.to_string(),
            between_holds_sd: InUnit::new("between_holds_sd", unit, per_axis(&still.between_holds_sd, 3)),
            rate_rms_radps: still.rate_rms_radps,
            rate_rms_before_radps: still.rate_rms_before_radps,
            before: &calibration.gyroscope_before.source,
        }
    }
}

/// The rotations between holds.
#[derive(Serialize)]
struct RotationsFields<'a> {
    used: usize,
    error_rms_rad: Option<f64>,
    error_before_rms_rad: Option<f64>,
    excess_sd_rad: f64,
    table: Vec<RotationFields<'a>>,
}

impl<'a> RotationsFields<'a> {
    fn of(calibration: &'a ImuCalibration) -> Self {
        let used = calibration.rotations.iter().filter(|rotation| rotation.used).count();
        let known = |rms: f64| (used > 0).then_some(rms);
        Self {
            used,
            error_rms_rad: known(calibration.rotation_rms_rad()),
            error_before_rms_rad: known(calibration.rotation_rms_before_rad()),
            excess_sd_rad: calibration.between_rotations_sd_rad,
            table: calibration.rotations.iter().map(RotationFields::of).collect(),
        }
    }
}

#[derive(Serialize)]
struct RotationFields<'a> {
    from_hold_index: usize,
    to_hold_index: usize,
    start_s: f64,
    end_s: f64,
    path_rad: Option<f64>,
    peak_radps: Option<f64>,
    error_rad: Option<f64>,
    error_before_rad: Option<f64>,
    studentised: Option<f64>,
    used: bool,
    reason: Option<String>,
}

impl<'a> RotationFields<'a> {
    fn of(rotation: &'a RotationResult) -> Self {
        let found = |value: f64| rotation.is_integrated().then_some(value);
        Self {
            from_hold_index: rotation.from_hold,
            to_hold_index: rotation.to_hold,
            start_s: rotation.start_s,
            end_s: rotation.end_s,
            path_rad: found(rotation.path_rad),
            peak_radps: found(rotation.peak_radps),
            error_rad: found(rotation.error_rad),
            error_before_rad: found(rotation.error_before_rad),
            studentised: found(rotation.studentised),
            used: rotation.used,
            reason: rotation.reason.map(|reason| reason.to_string()),
        }
    }
}

/// A turn of known angle.
#[derive(Serialize)]
struct TurnFields {
    start_s: f64,
    end_s: f64,
    angle_rad: Vec<f64>,
    measured_rad: Vec<f64>,
}

impl TurnFields {
    fn of(turn: &TurnResult) -> Self {
        Self {
            start_s: turn.start_s,
            end_s: turn.end_s,
            angle_rad: per_axis(&turn.angle_rad, 3),
            measured_rad: per_axis(&turn.measured_rad, 3),
        }
    }
}
