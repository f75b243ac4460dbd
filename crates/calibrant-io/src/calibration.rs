//! Writes `calibration.json` of an accelerometer or of an IMU: calibrant JSON of schema 2, and the further
//! results of the estimator. Every reader of calibrations takes it.

use super::acceptance::{LimitFields, VerdictFields};
use super::convention::{Heading, ImuCore};
use super::diagnostics::{DiagnosticFields, DiagnosticWords};
use super::gyroscope::{RotationsFields, StillFields, TurnFields};
use super::holds::HoldsFields;
use super::json;
use super::origin::{Origin, OriginFields};
use super::shared_fields::{FitFields, MotionFields, matrix_rows};
use super::validation::{ValidationFields, validation_fields};
use calibrant_core::error::Result;
use calibrant_core::estimate::{Calibration, Recovered, RecoveredGravity, RecoveredMotion, Validation};
use serde::Serialize;
use std::path::Path;

/// Writes `calibration.json`, which [`read_calibrated_imu`](super::read_calibrated_imu) reads.
///
/// The same calibration gives the same bytes. A section is there where it has something to say: `motion` or
/// `holds`, and `still_gyroscope`, `rotations`, `turns` of an IMU. Arrays over axes have 1 or 3 entries.
/// Fields in the unit of the readings end in `_mps2`, `_radps` or `_counts`. Angles are in rad; of a rotation
/// that could not be integrated they are `null`. `validations` are the errors on data that the calibration
/// did not use. `origin` says of which sensor it is, and from which files.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_calibration(
    path: &Path,
    calibration: &Calibration,
    validations: &[Validation],
    origin: &Origin,
    words: &DiagnosticWords<'_>,
) -> Result<()> {
    json::write_json(path, &CalibrationFile::of(calibration, validations, origin, words))
}

/// The text that [`write_calibration`] writes.
#[must_use]
pub fn calibration_json(
    calibration: &Calibration,
    validations: &[Validation],
    origin: &Origin,
    words: &DiagnosticWords<'_>,
) -> String {
    json::to_json(&CalibrationFile::of(calibration, validations, origin, words))
}

#[derive(Serialize)]
struct CalibrationFile<'a> {
    #[serde(flatten)]
    heading: Heading,
    #[serde(flatten)]
    origin: OriginFields<'a>,
    verdict: VerdictFields,
    status: &'static str,
    iterations: usize,
    gradient_norm: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    prior: Option<&'static str>,
    #[serde(flatten)]
    core: ImuCore,
    correlation: Vec<Vec<f64>>,
    fit: FitFields,
    #[serde(skip_serializing_if = "Option::is_none")]
    motion: Option<RecoveredMotionFields>,
    #[serde(skip_serializing_if = "Option::is_none")]
    holds: Option<HoldsFields>,
    #[serde(skip_serializing_if = "Option::is_none")]
    still_gyroscope: Option<StillFields<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotations: Option<RotationsFields>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    turns: Vec<TurnFields>,
    #[serde(skip_serializing_if = "Option::is_none")]
    validation: Option<ValidationFields>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    limits: Vec<LimitFields>,
    warnings: Vec<DiagnosticFields>,
}

impl<'a> CalibrationFile<'a> {
    fn of(
        calibration: &'a Calibration,
        validations: &[Validation],
        origin: &'a Origin,
        words: &DiagnosticWords<'_>,
    ) -> Self {
        let (axes, unit) = (calibration.axes(), calibration.accelerometer_unit);
        let gyroscope = calibration.gyroscope.as_deref();
        let (motion, holds) = match &calibration.recovered {
            Recovered::Motion(motion) => (Some(RecoveredMotionFields::of(motion, axes)), None),
            Recovered::Holds(holds) => {
                let latitude_deg = gyroscope.and_then(|gyroscope| gyroscope.latitude_deg);
                (None, Some(HoldsFields::of(holds, unit).at_latitude(latitude_deg)))
            }
        };
        Self {
            heading: Heading::new(),
            origin: origin.fields(),
            verdict: words.verdict(&calibration.warnings),
            status: calibration.status.name(),
            iterations: calibration.iterations,
            gradient_norm: calibration.gradient_norm,
            prior: calibration.datasheet_prior.then_some("datasheet"),
            core: ImuCore::of(&calibration.calibrated(), axes, &origin.inputs).with_knowledge(calibration),
            correlation: matrix_rows(&calibration.correlation()),
            fit: FitFields::of(&calibration.fit, unit, axes),
            motion,
            holds,
            still_gyroscope: gyroscope.map(StillFields::of),
            rotations: gyroscope.map(|gyroscope| RotationsFields::of(calibration, gyroscope)),
            turns: calibration.turns().iter().map(TurnFields::of).collect(),
            validation: validation_fields(validations),
            limits: words.limit_fields(),
            warnings: DiagnosticFields::all(&calibration.warnings, words),
        }
    }
}

#[derive(Serialize)]
struct RecoveredMotionFields {
    trust: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    gravity: Option<GravityFields>,
    #[serde(flatten)]
    fields: MotionFields,
}

/// Gravity beside a motion, and its tilt, which was estimated with the parameters.
#[derive(Serialize)]
struct GravityFields {
    /// Specific force of the sensor at rest, as given, m/s².
    force_mps2: [f64; 3],
    /// Standard uncertainty of its magnitude, m/s².
    sd_mps2: f64,
    /// Standard deviation of the tilt beforehand, rad.
    tilt_prior_sd_rad: f64,
    tilt: Vec<TiltFields>,
}

#[derive(Serialize)]
struct TiltFields {
    name: String,
    value_rad: f64,
    sd_rad: f64,
}

impl GravityFields {
    fn of(recovered: &RecoveredGravity) -> Self {
        let gravity = &recovered.gravity;
        let tilt = |(name, value_rad, sd_rad)| TiltFields { name, value_rad, sd_rad };
        Self {
            force_mps2: gravity.force_mps2.into(),
            sd_mps2: gravity.sd_mps2,
            tilt_prior_sd_rad: gravity.tilt_sd_rad,
            tilt: recovered.tilts().into_iter().map(tilt).collect(),
        }
    }
}

impl RecoveredMotionFields {
    fn of(recovered: &RecoveredMotion, axes: usize) -> Self {
        let fields = MotionFields::of(&recovered.motion, axes, Some(&recovered.acceleration_sd_mps2));
        Self { trust: recovered.trust, gravity: recovered.gravity.as_ref().map(GravityFields::of), fields }
    }
}
