//! The results of a gyroscope, in addition to its parameters.

use crate::diagnostic::RotationReason;
use crate::estimate::imu::clock_rate::{ClockRate, TimeOffset};
use crate::estimate::imu::problem::NoiseSource;
use crate::estimate::imu::rotations::gravity_at_ends::TurnsInHolds;
use crate::estimate::recording_biases::RecordingBiases;
use crate::estimate::uncalibrated::Uncalibrated;
use crate::form::As;
use crate::sensor::ReadingUnit;
use nalgebra::{DVector, Vector3};
use schemars::JsonSchema;
use serde::Serialize;

/// The part of a calibration that belongs to the gyroscope.
#[derive(Debug, Clone)]
pub struct GyroscopeCalibration {
    /// Unit of its readings.
    pub unit: ReadingUnit,
    /// The gyroscope before its calibration.
    pub before: Uncalibrated,
    /// Its readings in the holds.
    pub still: GyroscopeInHolds,
    /// Its biases in earlier recordings, which were taken out of the readings. `None`: there is one recording, or one bias.
    pub recording_biases: Option<RecordingBiases>,
    /// The rotations between holds, in order of time.
    pub rotations: Vec<RotationResult>,
    /// Excess standard deviation of the rotation errors, beyond the gyroscope's noise, per axis, rad.
    pub between_rotations_sd_rad: f64,
    /// Root mean square of the knock factors: the error of a knock's integral over the fourth difference of its samples times their step. The usual one
    /// without knocks.
    pub knock_rms: f64,
    /// Turns within the holds, as the accelerometer shows them.
    pub(in crate::estimate) turns_in_holds: TurnsInHolds,
    /// The turns of known angle.
    pub turns: Vec<TurnResult>,
    /// The time offset of the gyroscope, if the rotations determine it.
    pub time_offset: Option<TimeOffset>,
    /// The rates of the sensors' clocks, if the rotations show a difference.
    pub clocks: Option<ClockRate>,
    /// Geographic latitude, degrees, if the Earth's rate about the vertical is part of the model.
    pub latitude_deg: Option<f64>,
    /// Error of each estimate by one standard deviation of the Earth's rate about the vertical, at an unknown latitude.
    pub(in crate::estimate) of_vertical: Option<DVector<f64>>,
    /// Root mean square of each component of the Earth's rate about the north, from this recording, rad/s.
    pub(in crate::estimate) north_rms_radps: f64,
}

/// The gyroscope in the holds.
#[derive(Debug, Clone, PartialEq)]
pub struct GyroscopeInHolds {
    /// Standard deviation of one sample's noise, in the unit of the readings.
    pub noise: Vector3<f64>,
    /// The source of the noise.
    pub noise_source: NoiseSource,
    /// Standard deviation of one sample about the mean of its hold. With coarse steps, at least their own scatter.
    pub within_holds_sd: Vector3<f64>,
    /// Between-hold standard deviation of the mean, beyond this noise.
    ///
    /// Its causes are a wandering bias, the parts of the Earth's rate that are not in the model, and a g-sensitivity that is not estimated.
    pub between_holds_sd: Vector3<f64>,
    /// The holds in which the gyroscope turns, from 0. Its readings there are not used.
    pub turning_holds: Vec<usize>,
    /// Root mean square over the holds of the calibrated mean rate, all axes together, rad/s. At a known latitude, the Earth's rate about the vertical
    /// is subtracted.
    pub rate_rms_radps: f64,
    /// Root mean square of the mean rates before the calibration, rad/s.
    pub rate_rms_before_radps: f64,
}

/// A rotation between two holds and its fit.
#[derive(Debug, Clone, PartialEq)]
pub struct RotationResult {
    /// The hold that it begins with, from 0.
    pub from_hold: usize,
    /// The hold that it ends in.
    pub to_hold: usize,
    /// Begin, s.
    pub start_s: f64,
    /// End, s.
    pub end_s: f64,
    /// Path of the rotation, `∫ |ω| dt`, rad.
    pub path_rad: f64,
    /// Largest rate, rad/s.
    pub peak_radps: f64,
    /// Rotation error: angle from propagated gravity to measured gravity, rad.
    pub error_rad: f64,
    /// Rotation error before the calibration, rad: with a mean bias, and the datasheet's gain or the mean gain.
    pub error_before_rad: f64,
    /// Rotation error in its expected standard deviations, without its own influence (studentised).
    pub studentised: f64,
    /// Was it used?
    pub used: bool,
    /// Why it was not used.
    pub reason: Option<RotationReason>,
}

/// A turn of known angle and its fit.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TurnResult {
    /// Begin, s.
    pub start_s: f64,
    /// End, s.
    pub end_s: f64,
    /// The given rotation, `φ e`, rad.
    #[serde(with = "As::<[f64; 3]>")]
    pub angle_rad: Vector3<f64>,
    /// The rotation that the calibrated gyroscope measures, rad.
    #[serde(with = "As::<[f64; 3]>")]
    pub measured_rad: Vector3<f64>,
}

impl RotationResult {
    /// Standard deviation that is expected of the rotation error, with its own influence on the fit, rad. Not a number without a rotation.
    #[must_use]
    pub fn error_sd_rad(&self) -> f64 {
        (self.error_rad / self.studentised).abs()
    }

    /// Could the gyroscope's readings be integrated? Otherwise path, rate and errors are zero, without a meaning.
    #[must_use]
    pub fn is_integrated(&self) -> bool {
        self.path_rad > 0.0
    }
}
