//! `calibration.json` of an accelerometer: writes a calibration with everything needed to use it and to judge
//! it.

use super::diagnostics::{DiagnosticFields, DiagnosticWords};
use super::holds::HoldsFields;
use super::json;
use super::shared_fields::{EstimateFields, FitFields, InUnit, MotionFields, block, matrix_rows, per_axis};
use super::validation::{ValidationFields, validation_fields};
use calibrant_core::error::Result;
use calibrant_core::estimate::{Calibration, Recovered, Validation};
use calibrant_core::sensor::{Correction, ReadingUnit, Recording};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The recording from which a calibration came.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// Name of the file, without its directory, so that the result does not depend on the directory.
    pub file: String,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
    /// Number of samples read.
    pub samples: usize,
    /// Sample rate, Hz.
    pub rate_hz: f64,
}

impl Input {
    /// What was read of a file: `sha256` of its bytes, and the readings of its sensor.
    #[must_use]
    pub fn of(path: &Path, sha256: &str, readings: Option<&Recording>) -> Self {
        Self {
            file: file_name(path),
            sha256: sha256.to_owned(),
            samples: readings.map_or(0, Recording::len),
            rate_hz: readings.map_or(0.0, Recording::rate_hz),
        }
    }
}

/// Name of a file, without its directory.
#[must_use]
pub fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// Writes `calibration.json`.
///
/// `validations` are the errors of the calibration on data that it did not use. The same calibration gives
/// the same bytes. Arrays over axes have 1 or 3 entries. Entry (i, j) of the covariance is in the unit of
/// parameter i times that of parameter j. Fields in the unit of the readings end in `_mps2` or `_counts`.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_calibration(
    path: &Path,
    calibration: &Calibration,
    validations: &[Validation],
    input: &Input,
    words: &DiagnosticWords<'_>,
) -> Result<()> {
    json::write_json(path, &CalibrationFile::of(calibration, validations, input, words))
}

/// The text that [`write_calibration`] writes.
#[must_use]
pub fn calibration_json(
    calibration: &Calibration,
    validations: &[Validation],
    input: &Input,
    words: &DiagnosticWords<'_>,
) -> String {
    json::to_json(&CalibrationFile::of(calibration, validations, input, words))
}

#[derive(Serialize)]
struct CalibrationFile<'a> {
    schema: u32,
    status: &'static str,
    iterations: usize,
    gradient_norm: f64,
    prior: &'static str,
    parameters: Vec<EstimateFields>,
    covariance: Vec<Vec<f64>>,
    correlation: Vec<Vec<f64>>,
    fit: FitFields,
    #[serde(skip_serializing_if = "Option::is_none")]
    motion: Option<RecoveredMotionFields>,
    #[serde(skip_serializing_if = "Option::is_none")]
    holds: Option<HoldsFields>,
    #[serde(skip_serializing_if = "Option::is_none")]
    validation: Option<ValidationFields>,
    convention: Convention,
    warnings: Vec<DiagnosticFields>,
    input: &'a Input,
}

impl<'a> CalibrationFile<'a> {
    fn of(
        calibration: &'a Calibration,
        validations: &[Validation],
        input: &'a Input,
        words: &DiagnosticWords<'_>,
    ) -> Self {
        let axes = calibration.axes();
        let (motion, holds) = match &calibration.recovered {
            Recovered::Motion(recovered) => {
                let sd = Some(recovered.acceleration_sd_mps2.as_slice());
                let fields = MotionFields::of(&recovered.motion, axes, sd);
                (Some(RecoveredMotionFields { trust: recovered.trust, fields }), None)
            }
            Recovered::Holds(holds) => (None, Some(HoldsFields::of(holds, calibration.accelerometer_unit))),
        };
        Self {
            schema: 1,
            status: calibration.status.name(),
            iterations: calibration.iterations,
            gradient_norm: calibration.gradient_norm,
            prior: if calibration.datasheet_prior { "datasheet" } else { "none" },
            parameters: EstimateFields::all(calibration),
            covariance: matrix_rows(&calibration.covariance),
            correlation: matrix_rows(&calibration.correlation()),
            fit: FitFields::of(&calibration.fit, calibration.accelerometer_unit, axes),
            motion,
            holds,
            convention: Convention::of(calibration, axes),
            validation: validation_fields(validations),
            warnings: DiagnosticFields::all(&calibration.warnings, words),
            input,
        }
    }
}

#[derive(Serialize)]
struct RecoveredMotionFields {
    trust: &'static str,
    #[serde(flatten)]
    fields: MotionFields,
}

/// The meaning of the numbers: direction, frame, and the calibration in the other direction, ready to use.
#[derive(Serialize)]
struct Convention {
    direction: &'static str,
    covariance: &'static str,
    reading_unit: &'static str,
    gauge: Option<&'static str>,
    frame: &'static str,
    #[serde(flatten)]
    matrix: InUnit<Vec<Vec<f64>>>,
    #[serde(flatten)]
    bias: InUnit<Vec<f64>>,
    correction: Option<CorrectionFields>,
}

impl Convention {
    fn of(calibration: &Calibration, axes: usize) -> Self {
        let unit = calibration.accelerometer_unit;
        let gauge = match &calibration.recovered {
            Recovered::Motion(_) => None,
            Recovered::Holds(holds) => Some(holds.gauge),
        };
        Self {
            direction: "true to raw: y = S s + b",
            covariance: "entry (i, j) in the unit of parameter i times that of parameter j",
            reading_unit: unit.symbol(),
            gauge: gauge.map(|gauge| gauge.name()),
            frame: match gauge {
                None => "the axes of the commanded motion",
                Some(_) => "fixed by the gauge: S and its inverse have this form, with a positive diagonal",
            },
            matrix: InUnit::gain("matrix", unit, block(&calibration.imu.accelerometer.matrix, axes)),
            bias: InUnit::new("bias", unit, per_axis(&calibration.imu.accelerometer.bias, axes)),
            correction: Correction::of(&calibration.imu.accelerometer)
                .map(|correction| CorrectionFields::of(&correction, unit, axes, gauge.is_some())),
        }
    }
}

/// The correction raw → true; for holds also in imu_tk's form.
#[derive(Serialize)]
struct CorrectionFields {
    direction: &'static str,
    #[serde(flatten)]
    matrix: InUnit<Vec<Vec<f64>>>,
    #[serde(flatten)]
    bias: InUnit<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    imu_tk: Option<ImuTkFields>,
}

#[derive(Serialize)]
struct ImuTkFields {
    form: &'static str,
    misalignment: Vec<Vec<f64>>,
    #[serde(flatten)]
    gains: InUnit<Vec<f64>>,
}

impl CorrectionFields {
    fn of(correction: &Correction, unit: ReadingUnit, axes: usize, holds: bool) -> Self {
        Self {
            direction: "raw to true: s = C (y - b)",
            matrix: InUnit::inverse_gain("matrix", unit, block(&correction.matrix, axes)),
            bias: InUnit::new("bias", unit, per_axis(&correction.bias, axes)),
            imu_tk: holds.then(|| ImuTkFields {
                form: "s = T K (y - b): misalignment is T, gains are 1/K",
                misalignment: block(&correction.misalignment(), axes),
                gains: InUnit::gain("gains", unit, per_axis(&correction.scale().map(|k| 1.0 / k), axes)),
            }),
        }
    }
}
