//! The result of a calibration.

use super::gravity_error::gravity_source;
use super::hold_result::{HoldCalibration, HoldResult};
use super::imu::{GyroscopeCalibration, RotationResult, TurnResult};
use super::{RecoveredClock, RecoveredGravity, SoakTemperature, datasheet};
use crate::diagnostic::{Change, Diagnostic};
use crate::estimate::budget::BudgetRow;
use crate::estimate::imu::KnownTerm;
use crate::motion::JerkControlledMotion;
use crate::sensor::{
    Axis, CalibratedImu, CovarianceDegrees, CovariancePart, Gauge, ImuParameters, ImuQuantity, Parameter,
    PerSensor, Quantity, ReadingUnit, SensorKind, SensorModel, SharedErrors,
};
use crate::solve::{CalibrationStatus, VarianceSource};
use nalgebra::{DMatrix, Vector3};

/// With fewer degrees of freedom left by a drift, the scatter between holds is at least that of the fit without it.
const FEWEST_DEGREES: f64 = 6.0;

/// A calibration of an accelerometer or of an IMU: parameters, their one covariance, and everything needed to judge them.
///
/// `recovered` has the estimated motion, the holds, or that it was a machine. `gyroscope` has what a gyroscope by hand adds.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// How the iteration ended.
    pub status: CalibrationStatus,
    /// Iterations used.
    pub iterations: usize,
    /// Norm of the gradient at the end in the metric of the covariance, `√(gᵀ Σ g)`: the length of the remaining step,
    /// in standard deviations. Zero at the optimum.
    pub gradient_norm: f64,
    /// The quantities that were estimated.
    pub quantities: Vec<ImuQuantity>,
    /// Name, unit, nominal value and datasheet spread of each quantity.
    pub parameters: Vec<Parameter>,
    /// Estimates, in the order of `quantities`.
    pub values: Vec<f64>,
    /// Covariance of the estimates, p × p, entry (i, j) in unit i times unit j. The motion (or the directions) is marginalised.
    pub covariance: DMatrix<f64>,
    /// Where the variance of each estimate comes from; empty for a commanded motion.
    pub budget: Vec<BudgetRow>,
    /// The share of each quantity's information that comes from the prior, 0 to 1. Empty without a prior, and for a commanded motion.
    pub prior_share: Vec<f64>,
    /// Derivative of each estimate with respect to the assumed gravity, in its unit over m/s². Empty for a commanded motion, and on a machine.
    pub gravity_slope: Vec<f64>,
    /// Is the datasheet a prior?
    pub datasheet_prior: bool,
    /// The estimates as a model, fixed quantities included. A sensor that was not calibrated is a perfect one.
    pub imu: ImuParameters,
    /// Unit of each sensor's readings; `None` where it was not calibrated.
    pub units: PerSensor<Option<ReadingUnit>>,
    /// The sensitivity by which counts became readings in these units, counts per m/s² or rad/s; `None` where they were not counts, or stayed counts.
    pub counts_per_unit: PerSensor<Option<f64>>,
    /// How well the model fits the data.
    pub fit: FitStatistics,
    /// The motion or the holds, estimated with the parameters.
    pub recovered: Recovered,
    /// The results of a gyroscope by hand, if there is one.
    pub gyroscope: Option<Box<GyroscopeCalibration>>,
    /// The temperature over the holds, where the recording has one.
    pub soak: Option<SoakTemperature>,
    /// What other soaks of a campaign say of the parameters, on which the estimates rest; empty where the recording determines them by itself.
    pub soak_prior: Vec<KnownTerm>,
    /// Changes of a sensor within the recording.
    pub changes: Vec<Change>,
    /// Warnings for the user.
    pub warnings: Vec<Diagnostic>,
}

impl Calibration {
    /// Standard deviation of each estimate.
    #[must_use]
    pub fn sd(&self) -> Vec<f64> {
        self.covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect()
    }

    /// What of the accelerometer the datasheet does not allow: a parameter, and bias and gains of readings in SI that no sensor has.
    pub(crate) fn beyond_datasheet(&self) -> Vec<Diagnostic> {
        let (parameters, values, sd) = (&self.parameters, &self.values, self.sd());
        let allowed =
            |axis: Axis| axis.index() >= self.axes() || datasheet::allows_gain(parameters, values, &sd, axis);
        let (kind, matrix) = (SensorKind::Accelerometer, &self.imu[SensorKind::Accelerometer].matrix);
        let gains = datasheet::implausible_gains(kind, self.unit(SensorKind::Accelerometer), matrix, allowed);
        let allowed = |axis: Axis| datasheet::allows_bias(parameters, values, &sd, axis);
        let bias = datasheet::implausible_bias(
            self.unit(SensorKind::Accelerometer),
            &self.imu[SensorKind::Accelerometer].bias,
            allowed,
        );
        datasheet::beyond_datasheet(parameters, values, &sd).into_iter().chain(bias).chain(gains).collect()
    }

    /// The sources that variances come from.
    #[must_use]
    pub fn variance_sources(&self) -> Vec<VarianceSource> {
        let is_used = |source: &VarianceSource| self.budget.iter().any(|row| row.part(*source) > 0.0);
        VarianceSource::ALL.into_iter().filter(is_used).collect()
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
    pub fn sensor_kinds(&self) -> Vec<SensorKind> {
        self.units.present().map(|(sensor_kind, _)| sensor_kind).collect()
    }

    /// Number of axes that were calibrated: that of the accelerometer's biases.
    #[must_use]
    pub fn axes(&self) -> usize {
        let bias = |axis: &Axis| ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(*axis));
        match self.recovered {
            Recovered::Motion(_) => {
                Axis::ALL.iter().filter(|axis| self.quantities.contains(&bias(axis))).count()
            }
            Recovered::Holds(_) | Recovered::OnMachine(_) => 3,
        }
    }

    /// Unit of the readings of a sensor; that of its stimulus where it was not calibrated.
    #[must_use]
    pub fn unit(&self, sensor_kind: SensorKind) -> ReadingUnit {
        self.units[sensor_kind].unwrap_or(sensor_kind.stimulus_unit())
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

    /// The share of a quantity's information that comes from the prior. `None` below 5 %.
    #[must_use]
    pub fn known_beforehand(&self, place: usize) -> Option<f64> {
        self.prior_share.get(place).copied().filter(|share| *share > 0.05)
    }

    /// The holds. `None` for a commanded motion.
    #[must_use]
    pub fn holds(&self) -> Option<&HoldCalibration> {
        match &self.recovered {
            Recovered::Holds(holds) => Some(holds),
            Recovered::Motion(_) | Recovered::OnMachine(_) => None,
        }
    }

    /// Each hold. Empty for a commanded motion.
    #[must_use]
    pub fn hold_results(&self) -> &[HoldResult] {
        self.holds().map_or(&[], |holds| &holds.holds)
    }

    /// The rotations between holds, in order of time. Empty without a gyroscope.
    #[must_use]
    pub fn rotations(&self) -> &[RotationResult] {
        self.gyroscope.as_ref().map_or(&[], |gyroscope| &gyroscope.rotations)
    }

    /// The rotations that the gyroscope's parameters follow from: all but those left out.
    pub fn used_rotations(&self) -> impl Iterator<Item = &RotationResult> {
        self.rotations().iter().filter(|rotation| rotation.used)
    }

    /// The turns of known angle.
    #[must_use]
    pub fn turns(&self) -> &[TurnResult] {
        self.gyroscope.as_ref().map_or(&[], |gyroscope| &gyroscope.turns)
    }

    /// Do the known turns check the gyroscope's matrix? They do not if they are the only data, with no more equations than the matrix has entries.
    /// The fit is then exact.
    #[must_use]
    pub fn turns_check_the_gains(&self) -> bool {
        let of_matrix = |place: &usize| {
            let quantity = self.quantities[*place];
            matches!(quantity, ImuQuantity::Of(SensorKind::Gyroscope, _)) && !quantity.is_of_bias()
        };
        let known = |place: &usize| self.prior_share.get(*place).is_some_and(|share| *share > 0.0);
        let entries = (0..self.quantities.len()).filter(of_matrix).filter(|place| !known(place)).count();
        self.used_rotations().next().is_some() || 3 * self.turns().len() > entries
    }

    /// Root mean square of the rotation errors, over the used rotations, rad. Zero without any.
    #[must_use]
    pub fn rotation_rms_rad(&self) -> f64 {
        self.rms_of_used(|rotation| rotation.error_rad)
    }

    /// Root mean square of the rotation errors before the calibration, rad.
    #[must_use]
    pub fn rotation_rms_before_rad(&self) -> f64 {
        self.rms_of_used(|rotation| rotation.error_before_rad)
    }

    fn rms_of_used(&self, error: fn(&RotationResult) -> f64) -> f64 {
        let squares: Vec<f64> = self.used_rotations().map(|rotation| error(rotation).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    }

    /// The calibration in the form that other programs exchange.
    #[must_use]
    pub fn calibrated(&self) -> CalibratedImu {
        CalibratedImu {
            parameters: self.imu,
            units: self.units,
            counts_per_unit: self.counts_per_unit,
            quantities: self.quantities.clone(),
            covariance: Some(self.covariance.clone()),
            degrees_of_freedom: self.degrees_behind(),
            shared: self.shared_errors(),
            frame: self.frame(),
        }
    }

    /// The error of gravity: in the gains where it is the stimulus, in the biases where a motion is.
    fn shared_errors(&self) -> Option<SharedErrors> {
        let recovered = match &self.recovered {
            Recovered::Holds(holds) => {
                let of_one_sd = |slope: &f64| slope * holds.gravity.sd_mps2;
                let column: Vec<f64> = self.gravity_slope.iter().map(of_one_sd).collect();
                return SharedErrors::of_source(gravity_source(&holds.gravity), &column);
            }
            Recovered::Motion(motion) => motion.gravity.as_ref()?,
            Recovered::OnMachine(found) => return found.shared.clone(),
        };
        let gravity = recovered.gravity.magnitude();
        let along = self.imu[SensorKind::Accelerometer].matrix
            * recovered.gravity.force_mps2
            * (gravity.sd_mps2 / gravity.magnitude_mps2);
        let column = |(k, quantity): (usize, &ImuQuantity)| match quantity {
            ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(axis)) => {
                // a prior of the bias leaves σ² = s²u²/(s² + u²), and the part u s²/(s² + u²) of the error u
                let squared = along[axis.index()].powi(2);
                -along[axis.index()] * (self.covariance[(k, k)] / squared.max(f64::MIN_POSITIVE)).min(1.0)
            }
            _ => 0.0,
        };
        let column: Vec<f64> = self.quantities.iter().enumerate().map(column).collect();
        SharedErrors::of_source(gravity_source(&gravity), &column)
    }

    /// Degrees of freedom behind the covariance; `None` where they are not known.
    fn degrees_behind(&self) -> Option<CovarianceDegrees> {
        match &self.recovered {
            Recovered::Holds(holds) => Some(self.degrees_behind_holds(holds)),
            Recovered::Motion(_) => Some(CovarianceDegrees::known()),
            Recovered::OnMachine(_) => None,
        }
    }

    fn degrees_behind_holds(&self, holds: &HoldCalibration) -> CovarianceDegrees {
        // what numbers leave beside the unknowns of a part
        let left = |numbers: usize, part: CovariancePart, axes: f64| {
            let of_part = |k: &usize| self.quantities[*k].covariance_part() == part;
            let is_unknown = |k: usize| 1.0 - self.prior_share.get(k).copied().unwrap_or(0.0);
            numbers as f64 - (0..self.quantities.len()).filter(of_part).map(is_unknown).sum::<f64>() / axes
        };
        let of_scatter = |is_found: bool, left: f64| if is_found { left.max(1.0) } else { f64::INFINITY };
        let used = holds.used().count();
        let magnitudes = left(used, CovariancePart::Accelerometer, 1.0);
        let drift = holds.drift.as_ref().map_or(0.0, |drift| drift.degrees_of_freedom);
        let accelerometer = match holds.tilt {
            // the covariance of faces is already as wide as Student's t
            Some(_) => f64::INFINITY,
            None if magnitudes < 1.0 => 0.0,
            None => of_scatter(
                holds.between_holds_dominates,
                (magnitudes - drift).max(magnitudes.min(FEWEST_DEGREES)),
            ),
        };
        let Some(gyroscope) = &self.gyroscope else {
            return CovarianceDegrees { accelerometer, ..CovarianceDegrees::known() };
        };
        let still = &gyroscope.still;
        // each axis has a scatter of its own
        let means =
            left(used.saturating_sub(still.turning_holds.len()), CovariancePart::GyroscopeAtRest, 3.0);
        let rotations = left(2 * self.used_rotations().count(), CovariancePart::GyroscopeMatrix, 1.0);
        CovarianceDegrees {
            accelerometer,
            gyroscope_at_rest: of_scatter(still.between_holds_sd.max() > 0.0, means),
            gyroscope_matrix: of_scatter(gyroscope.between_rotations_sd_rad > 0.0, rotations),
        }
    }

    /// Did a commanded motion or known directions fix the true frame, and not a gauge? The accelerometer's matrix then has more entries than in a gauge.
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
            Recovered::OnMachine(found) => return found.frame.clone(),
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
    /// Probability of a χ² at least this large if model and noise are right. `None` without degrees of freedom, or if the noise was
    /// estimated from this fit.
    pub p_value: Option<f64>,
    /// Root mean square of the accelerometer's residuals per axis, in the unit of the readings; `None` for an IMU.
    pub residual_rms: Option<Vector3<f64>>,
    /// Noise assumed for one sample per axis, in the unit of the readings; `None` where it was estimated from this fit.
    pub assumed_noise: Option<Vector3<f64>>,
    /// Noise of one sample per axis, from the residuals, in the unit of the readings. `None` without degrees of freedom.
    pub noise_estimate: Option<Vector3<f64>>,
    /// Whiteness of the residuals, one test per axis; empty for holds.
    pub whiteness: Vec<Whiteness>,
}

impl FitStatistics {
    /// Noise of one sample per axis, in the unit of the readings: assumed, or from the residuals.
    #[must_use]
    pub fn sample_noise(&self) -> Option<Vector3<f64>> {
        self.assumed_noise.or(self.noise_estimate)
    }

    /// The statistics of a fit whose weights come from the data. Its χ² tests nothing.
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

/// What was estimated with the parameters: the motion or the holds.
#[derive(Debug, Clone)]
pub enum Recovered {
    /// The motion.
    Motion(RecoveredMotion),
    /// The holds.
    Holds(HoldCalibration),
    /// The motion of a machine: it stands in the result of the machine.
    OnMachine(FoundOnMachine),
}

/// What a calibration on a machine says of its parameters as a whole.
#[derive(Debug, Clone)]
pub struct FoundOnMachine {
    /// Errors of the parameters that another calibration on this machine has, too: gravity, geometry and zeros.
    pub shared: Option<SharedErrors>,
    /// The true frame, in words.
    pub frame: String,
}

/// The recovered motion.
#[derive(Debug, Clone)]
pub struct RecoveredMotion {
    /// Estimated motion.
    pub motion: JerkControlledMotion,
    /// Standard deviation of each node acceleration, m/s²; zero where it was known.
    pub acceleration_sd_mps2: Vec<Vector3<f64>>,
    /// Trust in the command: `known`, `noisy`, `unknown`.
    pub trust: &'static str,
    /// Gravity that the sensor sensed beside the motion, with its tilt. `None` where none was given.
    pub gravity: Option<RecoveredGravity>,
    /// The clock of the recording beside that of the motion.
    pub clock: RecoveredClock,
    /// Residuals `y − S s − b` of the samples used, in the unit of the readings.
    pub residuals: Vec<Vector3<f64>>,
    /// Index into the recording of the first residual's sample: the samples within the motion are contiguous.
    pub first_sample: usize,
}
