//! The fields of the gyroscope of a calibration in its JSON file: at rest, in rotations, in turns.

use super::shared_fields::{InUnit, per_axis};
use calibrant_core::estimate::{Calibration, GyroscopeCalibration, RotationResult, TurnResult};
use serde::Serialize;

/// The gyroscope in the holds.
#[derive(Serialize)]
pub(super) struct StillFields<'a> {
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
    pub(super) fn of(gyroscope: &'a GyroscopeCalibration) -> Self {
        let (still, unit) = (&gyroscope.still, gyroscope.unit);
        Self {
            noise: InUnit::new("noise_per_sample", unit, per_axis(&still.noise, 3)),
            noise_source: still.noise_source.to_string(),
            between_holds_sd: InUnit::new("between_holds_sd", unit, per_axis(&still.between_holds_sd, 3)),
            rate_rms_radps: still.rate_rms_radps,
            rate_rms_before_radps: still.rate_rms_before_radps,
            before: &gyroscope.before.source,
        }
    }
}

/// The rotations between holds.
#[derive(Serialize)]
pub(super) struct RotationsFields {
    used: usize,
    error_rms_rad: Option<f64>,
    error_before_rms_rad: Option<f64>,
    excess_sd_rad: f64,
    time_offset_s: Option<f64>,
    time_offset_sd_s: Option<f64>,
    table: Vec<RotationFields>,
}

impl RotationsFields {
    pub(super) fn of(calibration: &Calibration, gyroscope: &GyroscopeCalibration) -> Self {
        let used = calibration.used_rotations().count();
        let known = |rms: f64| (used > 0).then_some(rms);
        Self {
            used,
            error_rms_rad: known(calibration.rotation_rms_rad()),
            error_before_rms_rad: known(calibration.rotation_rms_before_rad()),
            excess_sd_rad: gyroscope.between_rotations_sd_rad,
            time_offset_s: gyroscope.time_offset.map(|time| time.offset_s),
            time_offset_sd_s: gyroscope.time_offset.map(|time| time.sd_s),
            table: gyroscope.rotations.iter().map(RotationFields::of).collect(),
        }
    }
}

#[derive(Serialize)]
struct RotationFields {
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

impl RotationFields {
    fn of(rotation: &RotationResult) -> Self {
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
pub(super) struct TurnFields {
    start_s: f64,
    end_s: f64,
    angle_rad: Vec<f64>,
    measured_rad: Vec<f64>,
}

impl TurnFields {
    pub(super) fn of(turn: &TurnResult) -> Self {
        Self {
            start_s: turn.start_s,
            end_s: turn.end_s,
            angle_rad: per_axis(&turn.angle_rad, 3),
            measured_rad: per_axis(&turn.measured_rad, 3),
        }
    }
}
