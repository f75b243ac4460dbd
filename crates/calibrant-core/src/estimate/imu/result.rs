//! What the calibration of an IMU gives.

use crate::diagnostic::RotationReason;
use crate::diagnostic::{Change, Diagnostic};
use crate::estimate::imu::clock::rate::ClockRate;
use crate::estimate::imu::problem::NoiseSource;
use crate::estimate::result::{CalibrationStatus, HoldCalibration};
use crate::estimate::uncalibrated::Uncalibrated;
use crate::sensor::{CalibratedImu, Gauge, ImuParameters, ImuQuantity, ReadingUnit, SensorKind, SensorModel};
use nalgebra::{DMatrix, DVector, Vector3};

/// A calibrated IMU: parameters, their one covariance, and everything needed to judge them.
#[derive(Debug, Clone)]
pub struct ImuCalibration {
    /// How the iteration ended.
    pub status: CalibrationStatus,
    /// Iterations of the joint problem.
    pub iterations: usize,
    /// Length of the step that is left, in standard deviations.
    pub gradient_norm: f64,
    /// The quantities that were estimated.
    pub quantities: Vec<ImuQuantity>,
    /// Estimates.
    pub values: Vec<f64>,
    /// Covariance, p × p; entry (i, j) in unit i times unit j. Directions are marginalised.
    pub covariance: DMatrix<f64>,
    /// What share of each quantity's information came from what was known beforehand, 0 to 1.
    pub prior_share: Vec<f64>,
    /// The estimates as a model, fixed quantities included.
    pub imu: ImuParameters,
    /// Unit of the accelerometer's readings.
    pub accelerometer_unit: ReadingUnit,
    /// Unit of the gyroscope's readings.
    pub gyroscope_unit: ReadingUnit,
    /// Geographic latitude by which the Earth's turn about the vertical is part of the model, degrees.
    pub latitude_deg: Option<f64>,
    /// How each estimate is off by one standard deviation of the Earth's rate about the vertical, where the latitude is unknown.
    pub(in crate::estimate) of_vertical: Option<DVector<f64>>,
    /// Root mean square of each component of the Earth's rate about the north by this recording, rad/s.
    pub(in crate::estimate) north_rms_radps: f64,
    /// Weighted sum of squares of all residuals.
    pub chi2: f64,
    /// Residuals less unknowns.
    pub degrees_of_freedom: usize,
    /// The holds.
    pub holds: HoldCalibration,
    /// What the gyroscope showed in the holds.
    pub still: GyroscopeInHolds,
    /// The gyroscope before its calibration.
    pub gyroscope_before: Uncalibrated,
    /// The rotations between holds, in order of time.
    pub rotations: Vec<RotationResult>,
    /// Error of a rotation beyond what the gyroscope's noise explains, per axis, rad.
    pub between_rotations_sd_rad: f64,
    /// The turns of known angle.
    pub turns: Vec<TurnResult>,
    /// Mean temperature of each of the holds, °C, where something follows temperature.
    pub hold_temperatures_c: Option<Vec<f64>>,
    /// Sensors that are not the same throughout the recording.
    pub changes: Vec<Change>,
    /// The rates of the sensors' clocks, where the rotations show that they differ.
    pub clocks: Option<ClockRate>,
    /// Things a user should know, in words.
    pub warnings: Vec<Diagnostic>,
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

impl ImuCalibration {
    /// Standard deviation of each estimate.
    #[must_use]
    pub fn sd(&self) -> Vec<f64> {
        self.covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect()
    }

    /// Correlation matrix of the estimates.
    #[must_use]
    pub fn correlation(&self) -> DMatrix<f64> {
        let sd = self.sd();
        DMatrix::from_fn(sd.len(), sd.len(), |i, j| match sd[i] * sd[j] {
            _ if i == j => 1.0,
            scale if scale > 0.0 => self.covariance[(i, j)] / scale,
            _ => 0.0,
        })
    }

    /// What share of a quantity's information was known beforehand, where it is worth telling: above 5 %.
    #[must_use]
    pub fn known_beforehand(&self, place: usize) -> Option<f64> {
        self.prior_share.get(place).copied().filter(|share| *share > 0.05)
    }

    /// Places of one sensor's quantities in the list.
    #[must_use]
    pub fn places_of(&self, sensor_kind: SensorKind) -> Vec<usize> {
        (0..self.quantities.len()).filter(|&k| self.quantities[k].sensor_kind() == sensor_kind).collect()
    }

    /// Unit of a quantity.
    #[must_use]
    pub fn unit_of(&self, quantity: ImuQuantity) -> &'static str {
        quantity.unit(match quantity.sensor_kind() {
            SensorKind::Accelerometer => self.accelerometer_unit,
            SensorKind::Gyroscope => self.gyroscope_unit,
        })
    }

    /// Root mean square of the angles by which gravity misses, over the rotations that were used, rad; zero where there is none.
    #[must_use]
    pub fn rotation_rms_rad(&self) -> f64 {
        self.rms_of_used(|rotation| rotation.error_rad)
    }

    /// The same before the calibration, rad.
    #[must_use]
    pub fn rotation_rms_before_rad(&self) -> f64 {
        self.rms_of_used(|rotation| rotation.error_before_rad)
    }

    /// Do the known turns check the gyroscope's matrix? Where they are all there is, and no more equations than it has entries, they determine it and are met exactly.
    #[must_use]
    pub fn turns_check_the_gains(&self) -> bool {
        let of_matrix = |place: &usize| {
            let quantity = self.quantities[*place];
            matches!(quantity, ImuQuantity::Of(SensorKind::Gyroscope, _)) && !quantity.is_of_bias()
        };
        let known = |place: &usize| self.prior_share.get(*place).is_some_and(|share| *share > 0.0);
        let entries = (0..self.quantities.len()).filter(of_matrix).filter(|place| !known(place)).count();
        self.rotations.iter().any(|rotation| rotation.used) || 3 * self.turns.len() > entries
    }

    fn rms_of_used(&self, error: fn(&RotationResult) -> f64) -> f64 {
        let squares: Vec<f64> =
            self.rotations.iter().filter(|rotation| rotation.used).map(|r| error(r).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    }

    /// As it is exchanged with other programs.
    #[must_use]
    pub fn calibrated(&self) -> CalibratedImu {
        CalibratedImu {
            parameters: self.imu,
            accelerometer_unit: Some(self.accelerometer_unit),
            gyroscope_unit: Some(self.gyroscope_unit),
            quantities: self.quantities.clone(),
            covariance: Some(self.covariance.clone()),
            frame: self.frame(),
        }
    }

    /// Did known directions of the holds fix the true frame (or the accelerometer's gauge)? Then its matrix has more entries than any gauge leaves.
    #[must_use]
    pub fn frame_is_known(&self) -> bool {
        let gauge = self.holds.gauge.parameter_list(SensorModel::Full);
        self.quantities.iter().any(|quantity| {
            matches!(quantity, ImuQuantity::Of(SensorKind::Accelerometer, of) if !gauge.quantities().contains(of))
        })
    }

    /// The true frame, in words.
    fn frame(&self) -> String {
        if self.frame_is_known() {
            return "that of the known directions of the holds".to_owned();
        }
        let form = match self.holds.gauge {
            Gauge::Lower => "lower triangular",
            Gauge::Upper => "upper triangular",
            Gauge::Symmetric => "symmetric",
        };
        format!("fixed by the accelerometer's gauge: its matrix is {form} with a positive diagonal")
    }
}
