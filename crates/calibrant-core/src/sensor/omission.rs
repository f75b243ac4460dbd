//! Parts of a calibration that some programs have no place for: the calibration without one, and what its correction then errs by.

use super::{CalibratedImu, ImuParameters, ImuQuantity, Quantity, SensorKind, SensorParameters, ThermalPart};
use nalgebra::{Matrix3, Vector3};

/// A part of a calibration that can be left out.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::{CalibratedImu, ImuParameters, ImuPart, ReadingUnit, SensorKind};
/// let mut parameters = ImuParameters::identity();
/// parameters[SensorKind::Accelerometer].matrix[(0, 1)] = 0.01;
/// let imu = CalibratedImu::new(parameters, [Some(ReadingUnit::MetrePerSecondSquared), None], vec![], "");
/// let plain = imu.without(ImuPart::CrossAxis);
/// let error = parameters.omission_error(&plain.parameters, SensorKind::Accelerometer);
/// assert!((error.largest - 0.01 * 9.80665).abs() < 1e-12, "x shows 1 % of y, which may be 1 g");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImuPart {
    /// What an axis of the accelerometer shows of the others.
    CrossAxis,
    /// Gain and alignment of the gyroscope.
    GyroscopeMatrix,
    /// What temperature does to the gains.
    GainTemperature,
    /// What the gyroscope shows of specific force.
    GSensitivity,
}

/// What a correction errs by where parts of it are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct OmissionError {
    /// The largest error of an axis of the corrected value, m/s² or rad/s.
    pub largest: f64,
    /// The stimuli and temperatures over which it is the largest, in words.
    pub over: String,
}

/// Standard gravity, at which errors of an accelerometer are stated.
const GRAVITY_MPS2: f64 = 9.806_65;
/// The rate at which errors of a gyroscope are stated, deg/s; they are proportional to it.
const RATE_DEGPS: f64 = 100.0;
/// Steps of the range of temperatures.
const STEPS: u32 = 1000;

impl ImuPart {
    /// All parts.
    pub const ALL: [Self; 4] =
        [Self::CrossAxis, Self::GyroscopeMatrix, Self::GainTemperature, Self::GSensitivity];

    /// Its name among the values of an option: `cross-axis`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::CrossAxis => "cross-axis",
            Self::GyroscopeMatrix => "gyroscope-matrix",
            Self::GainTemperature => "gain-temperature",
            Self::GSensitivity => "g-sensitivity",
        }
    }

    /// The part of this name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|part| part.name() == name)
    }

    /// It, in a sentence.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::CrossAxis => "cross-axis sensitivity",
            Self::GyroscopeMatrix => "gain and alignment",
            Self::GainTemperature => "gain over temperature",
            Self::GSensitivity => "the g-sensitivity",
        }
    }

    /// Has a sensor of the IMU this part, other than zero?
    #[must_use]
    pub fn is_of(self, sensor_kind: SensorKind, imu: &CalibratedImu) -> bool {
        let (sensor, gyroscope) = (imu.parameters.sensor(sensor_kind), sensor_kind == SensorKind::Gyroscope);
        imu.unit(sensor_kind).is_some()
            && match self {
                Self::CrossAxis => {
                    !gyroscope && sensor.matrix != Matrix3::from_diagonal(&sensor.matrix.diagonal())
                }
                Self::GyroscopeMatrix => gyroscope && sensor.matrix != Matrix3::identity(),
                Self::GainTemperature => {
                    imu.parameters.thermal.sensor(sensor_kind).scale
                        != [Vector3::zeros(); super::HIGHEST_ORDER]
                }
                Self::GSensitivity => gyroscope && imu.parameters.g_sensitivity != Matrix3::zeros(),
            }
    }

    fn holds(self, quantity: &ImuQuantity) -> bool {
        match (self, quantity) {
            (Self::GSensitivity, ImuQuantity::GSensitivity(..)) => true,
            (Self::GainTemperature, ImuQuantity::Thermal(_, term)) => term.part == ThermalPart::Scale,
            (Self::CrossAxis, ImuQuantity::Of(SensorKind::Accelerometer, quantity)) => {
                matches!(quantity, Quantity::CrossAxis(..) | Quantity::Symmetric(..))
            }
            (Self::GyroscopeMatrix, ImuQuantity::Of(SensorKind::Gyroscope, quantity)) => {
                !matches!(quantity, Quantity::Bias(_))
            }
            _ => false,
        }
    }
}

impl CalibratedImu {
    /// The same IMU without a part, as if it were known to be none.
    ///
    /// Without cross-axis sensitivity the correction keeps its diagonal: each axis has the gain `1/C_ii`. The matrix of a gyroscope
    /// becomes the identity, which suits readings in rad/s alone.
    #[must_use]
    pub fn without(&self, part: ImuPart) -> Self {
        let mut imu = self.clone();
        let parameters = &mut imu.parameters;
        match part {
            ImuPart::CrossAxis => {
                let sensor = &mut parameters[SensorKind::Accelerometer];
                let gains = sensor.matrix.try_inverse().map(|correction| correction.diagonal());
                sensor.matrix = Matrix3::from_diagonal(&gains.unwrap_or_else(Vector3::zeros).map(f64::recip));
            }
            ImuPart::GyroscopeMatrix => parameters[SensorKind::Gyroscope].matrix = Matrix3::identity(),
            ImuPart::GainTemperature => {
                for sensor_kind in SensorKind::ALL {
                    parameters.thermal[sensor_kind].scale = Default::default();
                }
            }
            ImuPart::GSensitivity => parameters.g_sensitivity = Matrix3::zeros(),
        }
        let kept: Vec<usize> =
            (0..self.quantities.len()).filter(|&k| !part.holds(&self.quantities[k])).collect();
        imu.restrict(&kept);
        imu
    }
}

impl ImuParameters {
    /// What the correction of a sensor errs by if `other` corrects its readings in the same true frame, over all directions of 1 g
    /// and of a rate, and over the range of temperatures.
    ///
    /// With `C = S'⁻¹` of the other, an axis errs by `(C S − 1) s + C (b − b') + C (Γ − Γ') f` at most.
    #[must_use]
    pub fn omission_error(&self, other: &Self, sensor_kind: SensorKind) -> OmissionError {
        let of_gyroscope = sensor_kind == SensorKind::Gyroscope;
        let size = if of_gyroscope { RATE_DEGPS.to_radians() } else { GRAVITY_MPS2 };
        let felt = if of_gyroscope { self.g_sensitivity - other.g_sensitivity } else { Matrix3::zeros() };
        let [low, high] = self.thermal.range_c.unwrap_or([self.thermal.reference_c; 2]);
        let (mut largest, mut by_stimulus, mut by_force) = (0.0_f64, false, false);
        for step in 0..=STEPS {
            let celsius = low + (high - low) * f64::from(step) / f64::from(STEPS);
            let [here, there]: [SensorParameters; 2] =
                [self, other].map(|of| of.sensor_at(sensor_kind, celsius));
            let Some(c) = there.matrix.try_inverse() else { continue };
            let gain = c * here.matrix - Matrix3::identity();
            let (offset, force) = (c * (here.bias - there.bias), c * felt);
            for axis in 0..3 {
                let of =
                    [gain.row(axis).norm() * size, offset[axis].abs(), force.row(axis).norm() * GRAVITY_MPS2];
                by_stimulus |= of[0] > 1e-12 * size;
                by_force |= of[2] > 0.0;
                largest = largest.max(of.iter().sum());
            }
            if low == high {
                break;
            }
        }
        let rate = format!("{RATE_DEGPS} deg/s");
        let mut over = match (by_stimulus, by_force, of_gyroscope) {
            (true, true, _) => format!(" at {rate} and 1 g"),
            (true, false, true) => format!(" at {rate}"),
            (false, false, _) => String::new(),
            _ => " at 1 g".into(),
        };
        if self.thermal.sensor(sensor_kind) != other.thermal.sensor(sensor_kind) && low < high {
            over += &format!(" from {low} to {high} °C");
        }
        OmissionError { largest, over }
    }
}
