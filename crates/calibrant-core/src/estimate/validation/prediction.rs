//! What a calibration claims to know: the parameters, their covariance, and the scatter that it found.

use super::statistics::Degrees;
use crate::estimate::earth::{UNKNOWN_SD_RADPS, vertical_slope};
use crate::estimate::imu::TurnsInHolds;
use crate::estimate::{Calibration, GyroscopeInHolds, HoldCalibration, ImuSetup};
use crate::motion::{Gravity, Hold};
use crate::sensor::{Axis, ImuParameters, ImuQuantity, Quantity, SensorKind, ThermalPart};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// The claim of a calibration.
#[derive(Debug, Clone)]
pub(super) struct Prediction {
    pub(super) imu: ImuParameters,
    pub(super) quantities: Vec<ImuQuantity>,
    /// Covariance of the quantities.
    pub(super) covariance: DMatrix<f64>,
    /// Gravity of the recording that is predicted, m/s².
    pub(super) gravity_mps2: f64,
    /// The Earth's rate about the vertical over gravity there, (rad/s)/(m/s²); 0 where it is not known.
    pub(super) vertical_rate: f64,
    /// Standard deviation of each component of the Earth's rate about the north there, rad/s.
    pub(super) north_sd_radps: f64,
    /// Scatter between holds, m/s², and the degrees of freedom behind it.
    pub(super) between_holds_sd_mps2: f64,
    pub(super) holds_degrees: Degrees,
    /// Standard deviation of an accelerometer sample within holds.
    pub(super) within: Vector3<f64>,
    /// Noise of a gyroscope sample, and how its samples scatter within holds.
    pub(super) still_noise: Vector3<f64>,
    pub(super) still_within: Vector3<f64>,
    /// Scatter between holds of each axis of the gyroscope, in the unit of its readings, and the degrees of freedom behind it.
    pub(super) still_sd: Vector3<f64>,
    pub(super) still_degrees: [Degrees; 3],
    /// Mean of the inverse durations of the holds that were used, 1/s: the variance of a mean's noise goes with it.
    pub(super) inverse_hold_s: f64,
    /// Error of a rotation beyond its noise, rad, and the degrees of freedom behind it.
    pub(super) rotation_sd_rad: f64,
    /// Error of a knock's integral over the fourth difference of its samples times their step.
    pub(super) knock_rms: f64,
    /// Turns within the holds.
    pub(super) turns_in_holds: TurnsInHolds,
    pub(super) rotation_degrees: Degrees,
    /// Variance of what coarse steps of the gyroscope leave in its means in another recording: its bias is not known better there, however many holds there are.
    pub(super) of_steps: Vector3<f64>,
}

impl Prediction {
    /// What a calibration from these holds claims of a recording made under this gravity, at this latitude.
    ///
    /// Where gravity is the one of the calibration, its uncertainty moves corrected and true magnitude alike and is left out; where it is another, both count. So with a latitude that is not known:
    /// it is the calibration's, or that of the calibration is known.
    pub(super) fn of(calibration: &Calibration, holds: &HoldCalibration, setup: &ImuSetup) -> Self {
        let gyroscope = calibration.gyroscope.as_deref();
        let still = gyroscope.map(|gyroscope| &gyroscope.still);
        let of_still = |of: fn(&GyroscopeInHolds) -> Vector3<f64>| still.map_or_else(Vector3::zeros, of);
        let used = holds.used().count();
        let rotations = calibration.used_rotations().count();
        let known = |quantity: &&ImuQuantity| quantity.sensor_kind() == SensorKind::Accelerometer;
        let accelerometer = calibration.quantities.iter().filter(known).count();
        let matrix = |quantity: &&ImuQuantity| match quantity {
            ImuQuantity::Of(SensorKind::Gyroscope, of) => !matches!(of, Quantity::Bias(_)),
            ImuQuantity::Thermal(SensorKind::Gyroscope, term) => term.part == ThermalPart::Scale,
            _ => false,
        };
        let of_rotations = calibration.quantities.iter().filter(matrix).count();
        // of an axis at rest: bias, its temperature terms, g-sensitivity
        let unknowns_at_rest = |axis: usize| {
            let of_axis = |quantity: &&ImuQuantity| match quantity {
                ImuQuantity::Thermal(SensorKind::Gyroscope, term) => {
                    term.part == ThermalPart::Bias && term.axis.index() == axis
                }
                ImuQuantity::GSensitivity(row, _) => row.index() == axis,
                _ => false,
            };
            1 + calibration.quantities.iter().filter(of_axis).count()
        };
        Self {
            imu: calibration.imu,
            quantities: calibration.quantities.clone(),
            covariance: without_place(calibration, holds, setup),
            gravity_mps2: setup.holds.gravity.magnitude_mps2,
            vertical_rate: setup.vertical_rate(),
            north_sd_radps: match gyroscope {
                Some(gyroscope) if gyroscope.latitude_deg.is_none() && setup.latitude_deg.is_none() => {
                    gyroscope.north_rms_radps
                }
                _ => setup.north_sd(),
            },
            // how well the sensor was placed on known faces is no property of the sensor
            between_holds_sd_mps2: if calibration.frame_is_known() {
                0.0
            } else {
                holds.between_holds_sd_mps2
            },
            holds_degrees: Degrees::of_scatter(used, accelerometer),
            within: within(holds),
            still_noise: of_still(|still| still.noise),
            still_within: of_still(|still| still.within_holds_sd),
            still_sd: of_still(|still| still.between_holds_sd),
            still_degrees: std::array::from_fn(|axis| Degrees::of_scatter(used, unknowns_at_rest(axis))),
            inverse_hold_s: inverse_duration(holds.used().map(|used| &used.hold)),
            rotation_sd_rad: gyroscope.map_or(0.0, |gyroscope| gyroscope.between_rotations_sd_rad),
            knock_rms: gyroscope.map_or(0.0, |gyroscope| gyroscope.knock_rms),
            turns_in_holds: gyroscope
                .map_or_else(TurnsInHolds::default, |gyroscope| gyroscope.turns_in_holds),
            rotation_degrees: Degrees::of_scatter(2 * rotations, of_rotations),
            of_steps: Vector3::zeros(),
        }
    }

    /// The claim for a recording whose gyroscope has coarse steps, which leave this variance in its means: at rest all holds have that error in common.
    pub(super) fn with_steps(&self, of_steps: &Vector3<f64>) -> Self {
        let mut prediction = Self { of_steps: *of_steps, ..self.clone() };
        for axis in Axis::ALL {
            if let Some(k) = self.place_of_bias(axis) {
                prediction.covariance[(k, k)] += of_steps[axis.index()] - self.of_steps[axis.index()];
            }
        }
        prediction
    }

    /// The covariance as if the gyroscope's bias were known, but for what coarse steps leave.
    pub(super) fn covariance_without_bias(&self) -> DMatrix<f64> {
        let axis_of = |k: usize| match self.quantities[k] {
            ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Bias(axis)) => Some(axis.index()),
            _ => None,
        };
        let size = self.quantities.len();
        DMatrix::from_fn(size, size, |i, j| match (axis_of(i), axis_of(j)) {
            (None, None) => self.covariance[(i, j)],
            (Some(axis), _) if i == j => self.of_steps[axis],
            _ => 0.0,
        })
    }

    fn place_of_bias(&self, axis: Axis) -> Option<usize> {
        let bias = ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Bias(axis));
        self.quantities.iter().position(|quantity| *quantity == bias)
    }

    /// The claim with another bias of the gyroscope, found where it is used: it has moved by `shift` (rad/s) of this covariance.
    pub(super) fn with_bias_moved_by(&self, shift: &Vector3<f64>, covariance: &Matrix3<f64>) -> Self {
        let matrix = self.imu[SensorKind::Gyroscope].matrix;
        let of_bias = matrix * covariance * matrix.transpose();
        let mut prediction = Self { covariance: self.covariance_without_bias(), ..self.clone() };
        prediction.imu[SensorKind::Gyroscope].bias += matrix * shift;
        for row in Axis::ALL {
            for column in Axis::ALL {
                if let (Some(i), Some(j)) = (self.place_of_bias(row), self.place_of_bias(column)) {
                    prediction.covariance[(i, j)] = of_bias[(row.index(), column.index())];
                }
            }
        }
        prediction
    }
}

fn within(holds: &HoldCalibration) -> Vector3<f64> {
    Hold::pooled_sd(holds.used().map(|hold| &hold.hold))
}

/// Mean of the inverse durations of holds, 1/s.
pub(super) fn inverse_duration<'a>(holds: impl Iterator<Item = &'a Hold>) -> f64 {
    let (sum, count) = holds.fold((0.0, 0_u32), |(sum, count), hold| {
        (sum + hold.duration_s().max(f64::MIN_POSITIVE).recip(), count + 1)
    });
    sum / f64::from(count.max(1))
}

/// The covariance without the uncertainty that gravity and latitude have in common here and there.
fn without_place(calibration: &Calibration, holds: &HoldCalibration, setup: &ImuSetup) -> DMatrix<f64> {
    let Calibration { covariance, quantities, imu, prior_share, gravity_slope, .. } = calibration;
    let covariance = recentred(covariance, gravity_slope, &holds.gravity, &setup.holds.gravity);
    let Some(gyroscope) = &calibration.gyroscope else { return covariance };
    match (&gyroscope.of_vertical, setup.latitude_deg) {
        (Some(slope), None) => covariance - slope * slope.transpose(),
        (None, None) => {
            let slope = vertical_slope(quantities, prior_share, imu, holds.gravity.magnitude_mps2);
            covariance + &slope * slope.transpose() * UNKNOWN_SD_RADPS.powi(2)
        }
        (_, Some(_)) => covariance,
    }
}

/// The covariance without the uncertainty of the calibration's gravity where the new one is the same, with that of both where it is not: an error of the new
/// gravity looks like one of the scale factors.
fn recentred(
    covariance: &DMatrix<f64>,
    gravity_slope: &[f64],
    calibrated: &Gravity,
    now: &Gravity,
) -> DMatrix<f64> {
    let variance = if calibrated == now { -now.sd_mps2.powi(2) } else { now.sd_mps2.powi(2) };
    let slope = DVector::from_column_slice(gravity_slope);
    covariance + &slope * slope.transpose() * variance
}
