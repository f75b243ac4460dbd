//! What a calibration says of a gyroscope, beside its parameters.

use crate::diagnostic::RotationReason;
use crate::estimate::imu::clock::rate::ClockRate;
use crate::estimate::imu::problem::NoiseSource;
use crate::estimate::uncalibrated::Uncalibrated;
use crate::sensor::ReadingUnit;
use nalgebra::{DVector, Vector3};

/// What a gyroscope adds to a calibration.
#[derive(Debug, Clone)]
pub struct GyroscopeCalibration {
    /// Unit of its readings.
    pub unit: ReadingUnit,
    /// The gyroscope before its calibration.
    pub before: Uncalibrated,
    /// What it showed in the holds.
    pub still: GyroscopeInHolds,
    /// The rotations between holds, in order of time.
    pub rotations: Vec<RotationResult>,
    /// Error of a rotation beyond what the gyroscope's noise explains, per axis, rad.
    pub between_rotations_sd_rad: f64,
    /// The turns of known angle.
    pub turns: Vec<TurnResult>,
    /// The rates of the sensors' clocks, where the rotations show that they differ.
    pub clocks: Option<ClockRate>,
    /// Geographic latitude by which the Earth's turn about the vertical is part of the model, degrees.
    pub latitude_deg: Option<f64>,
    /// How each estimate is off by one standard deviation of the Earth's rate about the vertical, where the latitude is unknown.
    pub(in crate::estimate) of_vertical: Option<DVector<f64>>,
    /// Root mean square of each component of the Earth's rate about the north by this recording, rad/s.
    pub(in crate::estimate) north_rms_radps: f64,
}

/// The gyroscope in the holds.
#[derive(Debug, Clone, PartialEq)]
pub struct GyroscopeInHolds {
    /// Standard deviation of one sample's noise, in the unit of the readings.
    pub noise: Vector3<f64>,
    /// Where it comes from.
    pub noise_source: NoiseSource,
    /// Standard deviation of one sample about the mean of its hold, whatever the noise was taken for; coarse steps make it no less than their own scatter.
    pub within_holds_sd: Vector3<f64>,
    /// Standard deviation between holds beyond this noise: a wandering bias, the Earth's rate about the north (and about the vertical, where the latitude is not known), g-sensitivity that is not estimated.
    pub between_holds_sd: Vector3<f64>,
    /// Root mean square over the holds of the mean rate that the calibrated gyroscope shows, less the Earth's about the vertical where the latitude is known, all axes together, rad/s.
    pub rate_rms_radps: f64,
    /// The same before the calibration, rad/s.
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
    /// Angle that the sensor went through, all turns to and fro, rad.
    pub path_rad: f64,
    /// Largest rate, rad/s.
    pub peak_radps: f64,
    /// Angle between gravity carried through the rotation and gravity found after it, rad.
    pub error_rad: f64,
    /// The same before the calibration, with the datasheet's or no gain errors: a plain mean bias and the mean gain; rad.
    pub error_before_rad: f64,
    /// Its error in standard deviations expected of it, its own influence removed.
    pub studentised: f64,
    /// Was it used?
    pub used: bool,
    /// Why it was not used.
    pub reason: Option<RotationReason>,
}

/// A turn of known angle and its fit.
#[derive(Debug, Clone, PartialEq)]
pub struct TurnResult {
    /// Begin, s.
    pub start_s: f64,
    /// End, s.
    pub end_s: f64,
    /// The rotation that was made, `φ e`, rad.
    pub angle_rad: Vector3<f64>,
    /// The rotation that the calibrated gyroscope shows, rad.
    pub measured_rad: Vector3<f64>,
}

impl RotationResult {
    /// Could the gyroscope's readings be integrated through it? Path, rate and errors of one that could not are zero and mean nothing.
    #[must_use]
    pub fn is_integrated(&self) -> bool {
        self.path_rad > 0.0
    }
}
