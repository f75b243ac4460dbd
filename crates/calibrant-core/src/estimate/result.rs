//! What a calibration gives.

use super::imu::{GyroscopeCalibration, RotationResult, TurnResult};
use super::uncalibrated::Uncalibrated;
use crate::diagnostic::{Change, Diagnostic, HoldLeftOut};
use crate::motion::{Gravity, Hold, JerkControlledMotion};
use crate::sensor::{
    Axis, CalibratedImu, Gauge, ImuParameters, ImuQuantity, Parameter, Quantity, ReadingUnit, SensorKind,
    SensorModel,
};
use nalgebra::{DMatrix, Vector3};

/// How the iteration ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationStatus {
    /// The step became smaller than the tolerance, in standard deviations of the parameters.
    Converged,
    /// The largest number of iterations was reached first. The numbers are the best found; do not use them without a look at the residuals.
    IterationLimit,
    /// No step lowered the cost any more although the tolerance was not met. The numbers are the best found.
    Stalled,
}

impl CalibrationStatus {
    /// As written in results: `converged`, `iteration_limit`, `stalled`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::IterationLimit => "iteration_limit",
            Self::Stalled => "stalled",
        }
    }
}

/// A calibration of an accelerometer or of an IMU: parameters, their one covariance, and everything needed to judge them.
///
/// What was measured of the motion is in `recovered`. A gyroscope, where there is one, adds its part.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// How the iteration ended.
    pub status: CalibrationStatus,
    /// Iterations used.
    pub iterations: usize,
    /// Norm of the gradient at the end in the metric of the covariance, `√(gᵀ Σ g)`: the length, in standard deviations, of the step that is
    /// left. Zero at the optimum.
    pub gradient_norm: f64,
    /// The quantities that were estimated.
    pub quantities: Vec<ImuQuantity>,
    /// Name, unit, nominal value and datasheet spread of each quantity.
    pub parameters: Vec<Parameter>,
    /// Estimates, in the order of `quantities`.
    pub values: Vec<f64>,
    /// Covariance of the estimates, p × p, entry (i, j) in unit i times unit j. The motion (or the directions) is marginalised.
    pub covariance: DMatrix<f64>,
    /// The share of each quantity's information that was known beforehand, 0 to 1; empty for an accelerometer alone, whose prior is the datasheet.
    pub prior_share: Vec<f64>,
    /// Did the datasheet count as a prior?
    pub datasheet_prior: bool,
    /// The estimates as a model, fixed quantities included. A sensor that was not calibrated is a perfect one.
    pub imu: ImuParameters,
    /// Unit of the accelerometer's readings.
    pub accelerometer_unit: ReadingUnit,
    /// How well the model fits the data.
    pub fit: FitStatistics,
    /// The motion or the holds that were estimated beside the parameters.
    pub recovered: Recovered,
    /// What the gyroscope adds, where there is one.
    pub gyroscope: Option<Box<GyroscopeCalibration>>,
    /// Sensors that are not the same throughout the recording.
    pub changes: Vec<Change>,
    /// Things a user should know.
    pub warnings: Vec<Diagnostic>,
}

impl Calibration {
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

    /// The sensors that were calibrated.
    #[must_use]
    pub fn sensor_kinds(&self) -> &'static [SensorKind] {
        if self.gyroscope.is_some() { &SensorKind::ALL } else { &[SensorKind::Accelerometer] }
    }

    /// Number of axes that were calibrated: that of the accelerometer's biases.
    #[must_use]
    pub fn axes(&self) -> usize {
        let bias = |axis: &Axis| ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(*axis));
        match self.recovered {
            Recovered::Motion(_) => {
                Axis::ALL.iter().filter(|axis| self.quantities.contains(&bias(axis))).count()
            }
            Recovered::Holds(_) => 3,
        }
    }

    /// Unit of the readings of a sensor.
    #[must_use]
    pub fn unit(&self, sensor_kind: SensorKind) -> ReadingUnit {
        match (sensor_kind, &self.gyroscope) {
            (SensorKind::Accelerometer, _) => self.accelerometer_unit,
            (SensorKind::Gyroscope, Some(gyroscope)) => gyroscope.unit,
            (SensorKind::Gyroscope, None) => sensor_kind.stimulus_unit(),
        }
    }

    /// Unit of a quantity.
    #[must_use]
    pub fn unit_of(&self, quantity: ImuQuantity) -> &'static str {
        quantity.unit(self.unit(quantity.sensor_kind()))
    }

    /// Places of one sensor's quantities in the list.
    #[must_use]
    pub fn places_of(&self, sensor_kind: SensorKind) -> Vec<usize> {
        (0..self.quantities.len()).filter(|&k| self.quantities[k].sensor_kind() == sensor_kind).collect()
    }

    /// The share of a quantity's information that was known beforehand, where it is worth a word: above 5 %.
    #[must_use]
    pub fn known_beforehand(&self, place: usize) -> Option<f64> {
        self.prior_share.get(place).copied().filter(|share| *share > 0.05)
    }

    /// The holds; `None` of a commanded motion.
    #[must_use]
    pub fn holds(&self) -> Option<&HoldCalibration> {
        match &self.recovered {
            Recovered::Motion(_) => None,
            Recovered::Holds(holds) => Some(holds),
        }
    }

    /// Each of the holds; none of a commanded motion.
    #[must_use]
    pub fn hold_results(&self) -> &[HoldResult] {
        self.holds().map_or(&[], |holds| &holds.holds)
    }

    /// The rotations between holds, in order of time; none without a gyroscope.
    #[must_use]
    pub fn rotations(&self) -> &[RotationResult] {
        self.gyroscope.as_ref().map_or(&[], |gyroscope| &gyroscope.rotations)
    }

    /// The turns of known angle.
    #[must_use]
    pub fn turns(&self) -> &[TurnResult] {
        self.gyroscope.as_ref().map_or(&[], |gyroscope| &gyroscope.turns)
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
        self.rotations().iter().any(|rotation| rotation.used) || 3 * self.turns().len() > entries
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

    fn rms_of_used(&self, error: fn(&RotationResult) -> f64) -> f64 {
        let squares: Vec<f64> =
            self.rotations().iter().filter(|rotation| rotation.used).map(|r| error(r).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    }

    /// As it is exchanged with other programs.
    #[must_use]
    pub fn calibrated(&self) -> CalibratedImu {
        CalibratedImu {
            parameters: self.imu,
            accelerometer_unit: Some(self.accelerometer_unit),
            gyroscope_unit: self.gyroscope.as_ref().map(|gyroscope| gyroscope.unit),
            quantities: self.quantities.clone(),
            covariance: Some(self.covariance.clone()),
            frame: self.frame(),
        }
    }

    /// Did a commanded motion or known directions of the holds fix the true frame (and not the accelerometer's gauge)? Then its matrix has more entries than any gauge leaves.
    #[must_use]
    pub fn frame_is_known(&self) -> bool {
        let Recovered::Holds(holds) = &self.recovered else { return true };
        let gauge = holds.gauge.parameter_list(SensorModel::Full);
        self.quantities.iter().any(|quantity| {
            matches!(quantity, ImuQuantity::Of(SensorKind::Accelerometer, of) if !gauge.quantities().contains(of))
        })
    }

    /// The true frame, in words.
    fn frame(&self) -> String {
        let form = match &self.recovered {
            Recovered::Motion(_) => return "the axes of the commanded motion".to_owned(),
            Recovered::Holds(_) if self.frame_is_known() => {
                return "that of the known directions of the holds".to_owned();
            }
            Recovered::Holds(holds) => match holds.gauge {
                Gauge::Lower => "lower triangular",
                Gauge::Upper => "upper triangular",
                Gauge::Symmetric => "symmetric",
            },
        };
        format!("fixed by the accelerometer's gauge: its matrix is {form} with a positive diagonal")
    }
}

/// How well the model fits the data.
#[derive(Debug, Clone, PartialEq)]
pub struct FitStatistics {
    /// Weighted sum of squared residuals χ², process noise and prior included.
    pub chi2: f64,
    /// Residuals less unknowns.
    pub degrees_of_freedom: usize,
    /// Probability of a χ² at least this large if model and noise are right; `None` without degrees of freedom, or where the
    /// noise was itself estimated from this fit.
    pub p_value: Option<f64>,
    /// Root mean square of the accelerometer's residuals per axis, in the unit of the readings; `None` for an IMU.
    pub residual_rms: Option<Vector3<f64>>,
    /// Noise assumed for one sample per axis, in the unit of the readings; `None` where it was estimated from this fit.
    pub assumed_noise: Option<Vector3<f64>>,
    /// Noise of one sample per axis as the residuals show it, in the unit of the readings; `None` without degrees of freedom.
    pub noise_estimate: Option<Vector3<f64>>,
    /// Whiteness of the residuals, one test per axis; empty for holds.
    pub whiteness: Vec<Whiteness>,
}

impl FitStatistics {
    /// Of a fit whose weights come from the data, so that χ² tests nothing.
    pub(in crate::estimate) fn of_chi2(chi2: f64, degrees_of_freedom: usize) -> Self {
        Self {
            chi2,
            degrees_of_freedom,
            p_value: None,
            residual_rms: None,
            assumed_noise: None,
            noise_estimate: None,
            whiteness: Vec::new(),
        }
    }
}

/// Ljung–Box test of one axis' residuals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whiteness {
    /// The statistic Q.
    pub statistic: f64,
    /// Number of lags tested.
    pub lags: usize,
    /// Probability of a Q at least this large if the noise is white.
    pub p_value: f64,
}

/// What was estimated beside the parameters.
#[derive(Debug, Clone)]
pub enum Recovered {
    /// The motion.
    Motion(RecoveredMotion),
    /// The holds.
    Holds(HoldCalibration),
}

/// The recovered motion.
#[derive(Debug, Clone)]
pub struct RecoveredMotion {
    /// Estimated motion.
    pub motion: JerkControlledMotion,
    /// Standard deviation of each node acceleration, m/s²; zero where it was known.
    pub acceleration_sd_mps2: Vec<Vector3<f64>>,
    /// How far the command was trusted: `known`, `noisy`, `unknown`.
    pub trust: &'static str,
    /// Residuals `y − S s − b` of the samples used, in the unit of the readings.
    pub residuals: Vec<Vector3<f64>>,
    /// Index into the recording of the first residual's sample: the samples within the motion are contiguous.
    pub first_sample: usize,
}

/// What a static calibration says beside the parameters.
#[derive(Debug, Clone)]
pub struct HoldCalibration {
    /// The holds, in order of time.
    pub holds: Vec<HoldResult>,
    /// Gravity that was assumed.
    pub gravity: Gravity,
    /// Gauge of the parameters.
    pub gauge: Gauge,
    /// Standard deviation of a hold's mean beyond what its samples' noise explains, m/s²; of holds of known directions, along these.
    pub between_holds_sd_mps2: f64,
    /// Does the scatter between holds exceed what the noise within them explains (so that it decides the covariance)?
    pub between_holds_dominates: bool,
    /// How well known directions were met; `None` where only the magnitude of gravity is known.
    pub tilt: Option<FaceTilt>,
    /// Root mean square over the used holds of the corrected magnitude less gravity, m/s².
    pub magnitude_residual_rms_mps2: f64,
    /// How many of the magnitudes of the used holds are left to check, the accelerometer's parameters and what was known beforehand counted off: with none, gravity is met exactly and checks nothing.
    pub degrees_of_freedom: usize,
    /// Condition number of the information on the parameters, each scaled by its own standard deviation when the others are known.
    pub condition_number: f64,
    /// Were the holds found in the recording (or given by the user)?
    pub detected: bool,
    /// The accelerometer before its calibration.
    pub before: Uncalibrated,
    /// Mean temperature of each of the holds, °C, where something follows temperature.
    pub temperatures_c: Option<Vec<f64>>,
    /// Is the accelerometer another one from some time on? `None` where nothing shows it, and where the directions are known.
    pub change: Option<Box<Change>>,
}

impl HoldCalibration {
    /// Magnitude of a hold's mean reading before the calibration, less gravity, m/s²; `None` where it cannot be told.
    #[must_use]
    pub fn magnitude_residual_before_mps2(&self, hold: &Hold) -> Option<f64> {
        let residual = self.before.stimulus(&hold.mean)?.norm() - self.gravity.magnitude_mps2;
        residual.is_finite().then_some(residual)
    }

    /// Root mean square of the same over the used holds, m/s²; `None` where it cannot be told.
    #[must_use]
    pub fn magnitude_residual_rms_before_mps2(&self) -> Option<f64> {
        let used: Vec<f64> = self
            .holds
            .iter()
            .filter(|result| result.used)
            .map(|result| self.magnitude_residual_before_mps2(&result.hold))
            .collect::<Option<_>>()?;
        (!used.is_empty()).then(|| (used.iter().map(|e| e * e).sum::<f64>() / used.len() as f64).sqrt())
    }
}

/// How well the sensor was placed on faces of known directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceTilt {
    /// Standard deviation of the tilt about each axis, rad.
    pub sd_rad: f64,
    /// Where that comes from.
    pub source: TiltSource,
    /// How many equations were left to tell it by their scatter; 0 where they did not.
    pub degrees_of_freedom: usize,
}

/// Where the tilt of faces comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TiltSource {
    /// It was given.
    Given,
    /// The scatter of the faces.
    Recording,
    /// Too few faces to tell: half a degree.
    Assumed,
}

impl TiltSource {
    /// In one word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Recording => "scatter",
            Self::Assumed => "assumed",
        }
    }
}

impl FaceTilt {
    /// Where it comes from, in words.
    #[must_use]
    pub fn source_in_words(&self) -> String {
        match self.source {
            TiltSource::Given => "as given".into(),
            TiltSource::Recording => {
                format!("by their scatter, {} degrees of freedom", self.degrees_of_freedom)
            }
            TiltSource::Assumed => "assumed, since the faces are too few".into(),
        }
    }
}

/// One hold and its fit.
#[derive(Debug, Clone)]
pub struct HoldResult {
    /// The hold.
    pub hold: Hold,
    /// Estimated specific force, m/s².
    pub force_mps2: Vector3<f64>,
    /// Magnitude of the mean reading less gravity, corrected with the parameters of the result, m/s².
    pub magnitude_residual_mps2: f64,
    /// The same in standard deviations expected of it, the hold's own influence removed.
    pub studentised_residual: f64,
    /// Was it used? A bad hold is found, reported and left out.
    pub used: bool,
    /// Why it was not used, where that was known before its residual: the sensor saturates in it.
    pub reason: Option<HoldLeftOut>,
}

impl HoldResult {
    /// Why it was left out; `None` where it was used.
    #[must_use]
    pub fn why_left_out(&self) -> Option<HoldLeftOut> {
        let by_residual = HoldLeftOut::MagnitudeOff {
            residual_mps2: self.magnitude_residual_mps2,
            studentised: self.studentised_residual,
        };
        (!self.used).then(|| self.reason.unwrap_or(by_residual))
    }
}
