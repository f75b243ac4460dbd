//! The datasheet of an accelerometer: what is known before a calibration. It gives the nominal parameters and
//! their spread, which tables show with name and unit.

use super::{
    Axis, ImuQuantity, ParameterList, Quantity, ReadingUnit, SensorKind, SensorModel, SensorParameters,
};
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::Serialize;

/// Noise of one sample of an accelerometer that a simulation or a design of poses takes where none is stated, m/s².
pub const USUAL_NOISE_MPS2: f64 = 0.01;

/// An accelerometer's datasheet: its model, the unit of its readings, its noise and the spread of its errors.
///
/// Spreads and noise are in SI. [`Sensor::noise`] and [`ParameterList::describe`] convert them to the unit of
/// the readings with the nominal gain. Where the readings are counts and no nominal gain is known, the gain
/// comes from the data.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::{Sensor, SensorModel};
///
/// let sensor = Sensor::triaxial(SensorModel::ScaleBias);
/// let names: Vec<_> = sensor.parameter_list().names();
/// assert_eq!(names, ["bias.x", "bias.y", "bias.z", "scale.x", "scale.y", "scale.z"]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Number of axes, 1 or 3.
    pub axes: usize,
    /// Which errors the model has.
    pub model: SensorModel,
    /// Unit of the readings.
    pub unit: ReadingUnit,
    /// Nominal gain per axis in counts/(m/s²); 1 where readings are in m/s²; `None` where it is not known.
    pub gain: Option<Vector3<f64>>,
    /// Nominal offset per axis, in the unit of the readings; `None` where it is not known.
    pub offset: Option<Vector3<f64>>,
    /// Standard deviation of the white noise of one sample, per axis, in m/s²; `None` where it is not known.
    pub noise_mps2: Option<Vector3<f64>>,
    /// The noise of one sample in counts. It is only for readings in counts, where it takes precedence.
    pub noise_counts: Option<Vector3<f64>>,
    /// Datasheet spread (standard deviation over the population) of the bias, per axis, in m/s².
    pub bias_sd_mps2: Option<Vector3<f64>>,
    /// Datasheet spread of the scale factors, relative, per axis.
    pub scale_sd: Option<Vector3<f64>>,
    /// Datasheet spread of the cross-axis sensitivities: the off-diagonal entries relative to the gain
    /// (radians for small angles).
    pub cross_axis_sd: Option<f64>,
    /// Largest stimulus that the sensor can report, per axis, m/s²: a limit of every motion.
    pub range_mps2: Option<Vector3<f64>>,
}

impl Sensor {
    /// A triaxial sensor with readings in m/s², nominally perfect. Nothing else of it is known.
    #[must_use]
    pub fn triaxial(model: SensorModel) -> Self {
        Self {
            axes: 3,
            model,
            unit: ReadingUnit::MetrePerSecondSquared,
            gain: Some(Vector3::repeat(1.0)),
            offset: Some(Vector3::zeros()),
            noise_mps2: None,
            noise_counts: None,
            bias_sd_mps2: None,
            scale_sd: None,
            cross_axis_sd: None,
            range_mps2: None,
        }
    }

    /// The accelerometer of the report, Memsic MXD2020U: `b ~ N(0, 0.1²)` m/s², `K ~ N(1, 0.005²)`, `σ_ν = 2e-4` m/s².
    #[must_use]
    pub fn memsic_mxd2020u() -> Self {
        Self {
            noise_mps2: Some(Vector3::repeat(2e-4)),
            bias_sd_mps2: Some(Vector3::repeat(0.1)),
            scale_sd: Some(Vector3::repeat(0.005)),
            ..Self::triaxial(SensorModel::ScaleBias)
        }
    }

    /// The axes that the sensor has.
    #[must_use]
    pub fn active_axes(&self) -> &'static [Axis] {
        &Axis::ALL[..self.axes]
    }

    /// The parameters that a recording of known or commanded motion can determine, in their order.
    #[must_use]
    pub fn parameter_list(&self) -> ParameterList {
        ParameterList::new(self.axes, self.model)
    }

    /// Nominal parameters, where gain and offset are known.
    #[must_use]
    pub fn nominal(&self) -> Option<SensorParameters> {
        Some(SensorParameters::linear(self.offset?, Matrix3::from_diagonal(&self.gain?)))
    }

    /// Standard deviation of one sample's noise per axis, in the unit of the readings, for a sensor of the given gain.
    #[must_use]
    pub fn noise(&self, gain: &Vector3<f64>) -> Option<Vector3<f64>> {
        match self.unit {
            ReadingUnit::MetrePerSecondSquared | ReadingUnit::RadianPerSecond => self.noise_mps2,
            ReadingUnit::Counts => {
                self.noise_counts.or_else(|| self.noise_mps2.map(|noise| noise.component_mul(gain)))
            }
        }
    }

    /// The same sensor with a usual noise, [`USUAL_NOISE_MPS2`], where its datasheet states none. `None` where it does.
    #[must_use]
    pub fn with_usual_noise(&self) -> Option<Self> {
        let is_stated = self.noise_mps2.is_some() || self.noise_counts.is_some();
        let noise_mps2 = Some(Vector3::repeat(USUAL_NOISE_MPS2));
        (!is_stated).then(|| Self { noise_mps2, ..self.clone() })
    }
}

/// One parameter as tables show it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Parameter {
    /// Name, as in [`Quantity::name`].
    pub name: String,
    /// Unit of value, nominal value and spread.
    pub unit: &'static str,
    /// Nominal value, where the datasheet gives it.
    pub nominal: Option<f64>,
    /// Datasheet spread: the standard deviation over the population, where the datasheet gives it.
    #[serde(rename = "spread_sd")]
    pub spread: Option<f64>,
}

impl Parameter {
    /// A quantity without datasheet values, for readings in this unit.
    #[must_use]
    pub fn undescribed(quantity: ImuQuantity, reading: ReadingUnit) -> Self {
        Self { name: quantity.name(), unit: quantity.unit(reading), nominal: None, spread: None }
    }
}

impl ParameterList {
    /// The same quantities, as those of the accelerometer of an IMU.
    #[must_use]
    pub fn of_accelerometer(&self) -> Vec<ImuQuantity> {
        self.quantities().iter().map(|of| ImuQuantity::Of(SensorKind::Accelerometer, *of)).collect()
    }

    /// As [`describe`](Self::describe), under the names of an IMU's accelerometer.
    #[must_use]
    pub fn describe_accelerometer(&self, sensor: &Sensor, like: &SensorParameters) -> Vec<Parameter> {
        let described = self.describe(sensor, like).into_iter().zip(self.of_accelerometer());
        described.map(|(parameter, of)| Parameter { name: of.name(), ..parameter }).collect()
    }

    /// Name, unit, nominal value and datasheet spread of each parameter. The gains of `like` turn relative
    /// spreads into spreads of the readings. `like` is the nominal sensor, or the estimate where no nominal
    /// gain is known.
    #[must_use]
    pub fn describe(&self, sensor: &Sensor, like: &SensorParameters) -> Vec<Parameter> {
        let nominal = sensor.nominal();
        self.quantities()
            .iter()
            .map(|&quantity| {
                let gain = |axis: Axis| like.matrix[(axis.index(), axis.index())].abs();
                let spread = match quantity {
                    Quantity::Bias(axis) => sensor.bias_sd_mps2.map(|sd| sd[axis.index()] * gain(axis)),
                    Quantity::Scale(axis) => sensor.scale_sd.map(|sd| sd[axis.index()] * gain(axis)),
                    Quantity::CrossAxis(row, _) | Quantity::Symmetric(row, _) => {
                        sensor.cross_axis_sd.map(|sd| sd * gain(row))
                    }
                    Quantity::Nonlinear(..) => None,
                };
                Parameter {
                    name: quantity.name(),
                    unit: quantity.unit(sensor.unit),
                    nominal: nominal.map(|nominal| quantity.value(&nominal)),
                    spread,
                }
            })
            .collect()
    }
}
