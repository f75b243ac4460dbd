//! What a calibration gives.

use super::{Change, Uncalibrated};
use crate::diagnostic::{Diagnostic, HoldLeftOut};
use crate::motion::{Gravity, Hold, JerkControlledMotion};
use crate::sensor::{Gauge, Parameter, ReadingUnit, SensorParameters};
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

/// A calibration: parameters, their covariance, and everything needed to judge them.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// How the iteration ended.
    pub status: CalibrationStatus,
    /// Iterations used.
    pub iterations: usize,
    /// Norm of the gradient at the end in the metric of the covariance, `√(gᵀ Σ g)`: the length, in standard deviations, of the step that is
    /// left. Zero at the optimum.
    pub gradient_norm: f64,
    /// Name, unit, nominal value and spread of each parameter.
    pub parameters: Vec<Parameter>,
    /// Estimates, in the order of `parameters`.
    pub values: Vec<f64>,
    /// Covariance of the estimates, p × p, entry (i, j) in unit i times unit j. The motion (or the directions) is marginalised.
    pub covariance: DMatrix<f64>,
    /// The estimates as `y = S s + b`.
    pub sensor: SensorParameters,
    /// Unit of the readings.
    pub unit: ReadingUnit,
    /// How well the model fits the data.
    pub fit: FitStatistics,
    /// The motion or the holds that were estimated beside the parameters.
    pub recovered: Recovered,
    /// Residuals `y − S s − b` of the samples used, in the unit of the readings; empty for holds (see [`HoldCalibration`]).
    pub residuals: Vec<Vector3<f64>>,
    /// Index into the recording of each residual's sample: the samples within the motion are contiguous, this is the first.
    pub first_sample: usize,
    /// Did the datasheet count as a prior?
    pub datasheet_prior: bool,
    /// Things a user should know, in words.
    pub warnings: Vec<Diagnostic>,
}

impl Calibration {
    /// Standard deviation of each parameter.
    #[must_use]
    pub fn sd(&self) -> Vec<f64> {
        (0..self.parameters.len()).map(|i| self.covariance[(i, i)].max(0.0).sqrt()).collect()
    }

    /// Correlation matrix of the parameters.
    #[must_use]
    pub fn correlation(&self) -> DMatrix<f64> {
        let sd = self.sd();
        DMatrix::from_fn(sd.len(), sd.len(), |i, j| {
            let scale = sd[i] * sd[j];
            if i == j {
                1.0
            } else if scale > 0.0 {
                self.covariance[(i, j)] / scale
            } else {
                0.0
            }
        })
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
    /// Root mean square of the residuals per axis, in the unit of the readings.
    pub residual_rms: Vector3<f64>,
    /// Noise assumed for one sample per axis, in the unit of the readings; `None` where it was estimated from this fit.
    pub assumed_noise: Option<Vector3<f64>>,
    /// Noise of one sample per axis as the residuals show it, in the unit of the readings; `None` without degrees of freedom.
    pub noise_estimate: Option<Vector3<f64>>,
    /// Whiteness of the residuals, one test per axis; empty for holds.
    pub whiteness: Vec<Whiteness>,
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
            TiltSource::Assumed => "assumed, since so few tell nothing of it".into(),
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
