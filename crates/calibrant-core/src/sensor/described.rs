//! Parameters as tables show them: name, unit, nominal value and datasheet spread.

use super::{Axis, ImuQuantity, ParameterList, Quantity, ReadingUnit, Sensor, SensorKind, SensorParameters};
use schemars::JsonSchema;
use serde::Serialize;

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
