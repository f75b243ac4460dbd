//! The fields of the holds of a calibration in its JSON file.

use super::shared_fields::{InUnit, per_axis};
use calibrant_core::estimate::{HoldCalibration, HoldResult};
use calibrant_core::sensor::ReadingUnit;
use serde::Serialize;

/// Gravity, gauge, scatter, and a row for each hold.
#[derive(Serialize)]
pub(super) struct HoldsFields {
    gravity_mps2: f64,
    gravity_sd_mps2: f64,
    /// With a latitude, the model contains Earth's rate about the vertical.
    #[serde(skip_serializing_if = "Option::is_none")]
    latitude_deg: Option<f64>,
    gauge: &'static str,
    detected: bool,
    between_holds_sd_mps2: f64,
    between_holds_dominates: bool,
    #[serde(flatten)]
    bias_drift: Option<InUnit<Vec<f64>>>,
    #[serde(flatten)]
    bias_drift_sd: Option<InUnit<Vec<f64>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    faces: Option<FacesFields>,
    /// With 0, the fit to the magnitudes is exact and checks nothing.
    degrees_of_freedom: usize,
    magnitude_residual_rms_mps2: f64,
    magnitude_residual_rms_before_mps2: Option<f64>,
    before: String,
    condition_number: f64,
    table: Vec<HoldFields>,
}

/// The face alignment of the holds.
#[derive(Serialize)]
struct FacesFields {
    tilt_sd_rad: f64,
    source: &'static str,
    /// Equations whose scatter determined it.
    degrees_of_freedom: usize,
}

#[derive(Serialize)]
struct HoldFields {
    first_sample: usize,
    end_sample: usize,
    samples: usize,
    start_s: f64,
    end_s: f64,
    #[serde(flatten)]
    mean: InUnit<Vec<f64>>,
    #[serde(flatten)]
    sd: InUnit<Vec<f64>>,
    force_mps2: Vec<f64>,
    magnitude_residual_mps2: f64,
    magnitude_residual_before_mps2: Option<f64>,
    studentised_residual: f64,
    used: bool,
    /// The reason why it was not used.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
}

impl HoldsFields {
    /// The holds of an accelerometer with readings in this unit.
    pub(super) fn of(holds: &HoldCalibration, unit: ReadingUnit) -> Self {
        let fields = |result: &HoldResult| HoldFields {
            first_sample: result.hold.first,
            end_sample: result.hold.end,
            samples: result.hold.samples(),
            start_s: result.hold.start_s,
            end_s: result.hold.end_s,
            mean: InUnit::new("mean", unit, per_axis(&result.hold.mean, 3)),
            sd: InUnit::new("sd", unit, per_axis(&result.hold.sd, 3)),
            force_mps2: per_axis(&result.force_mps2, 3),
            magnitude_residual_mps2: result.magnitude_residual_mps2,
            magnitude_residual_before_mps2: holds.magnitude_residual_before_mps2(&result.hold),
            studentised_residual: result.studentised_residual,
            used: result.used,
            reason: result.why_left_out().map(|why| why.to_string()),
        };
        Self {
            gravity_mps2: holds.gravity.magnitude_mps2,
            gravity_sd_mps2: holds.gravity.sd_mps2,
            latitude_deg: None,
            gauge: holds.gauge.name(),
            detected: holds.detected,
            between_holds_sd_mps2: holds.between_holds_sd_mps2,
            between_holds_dominates: holds.between_holds_dominates,
            bias_drift: holds
                .drift
                .as_deref()
                .map(|drift| InUnit::new("bias_drift", unit, per_axis(&drift.value, 3))),
            bias_drift_sd: holds
                .drift
                .as_deref()
                .map(|drift| InUnit::new("bias_drift_sd", unit, per_axis(&drift.sd(), 3))),
            faces: holds.tilt.map(|tilt| FacesFields {
                tilt_sd_rad: tilt.sd_rad,
                source: tilt.source.name(),
                degrees_of_freedom: tilt.degrees_of_freedom,
            }),
            degrees_of_freedom: holds.degrees_of_freedom,
            magnitude_residual_rms_mps2: holds.magnitude_residual_rms_mps2,
            magnitude_residual_rms_before_mps2: holds.magnitude_residual_rms_before_mps2(),
            before: holds.before.source.clone(),
            condition_number: holds.condition_number,
            table: holds.holds.iter().map(fields).collect(),
        }
    }

    /// With the latitude of an IMU, where it was known.
    pub(super) fn at_latitude(self, latitude_deg: Option<f64>) -> Self {
        Self { latitude_deg, ..self }
    }
}
