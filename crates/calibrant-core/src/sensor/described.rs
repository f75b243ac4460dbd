//! Parameters as tables show them: name, unit, nominal value and datasheet spread.

use super::{Axis, ParameterList, Quantity, Sensor, SensorParameters};

/// One parameter as tables show it.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name, as in [`Quantity::name`].
    pub name: String,
    /// Unit of value, nominal value and spread.
    pub unit: &'static str,
    /// Nominal value, where the datasheet gives it.
    pub nominal: Option<f64>,
    /// Datasheet spread: the standard deviation over the population, where the datasheet gives it.
    pub spread: Option<f64>,
}

impl ParameterList {
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
