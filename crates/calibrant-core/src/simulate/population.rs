//! Draws sensors at random from the datasheet.

use super::Rng;
use crate::sensor::{Quantity, Sensor, SensorParameters};
use nalgebra::{Matrix3, Vector3};
use rand_distr::{Distribution, StandardNormal};

/// A sensor drawn from the datasheet: each parameter `N(nominal, spread²)`, or the nominal value without a
/// spread. Where the datasheet gives no gain or offset, they count as 1 and 0.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::Sensor;
/// use calibrant_core::simulate::{Purpose, draw_sensor, stream};
/// let sensor = draw_sensor(&Sensor::memsic_mxd2020u(), &mut stream(1, Purpose::Sensor, 0));
/// assert!(sensor.bias.norm() > 0.0 && (sensor.matrix[(0, 0)] - 1.0).abs() < 0.05);
/// ```
pub fn draw_sensor(datasheet: &Sensor, rng: &mut Rng) -> SensorParameters {
    let mut sensor = SensorParameters {
        bias: datasheet.offset.unwrap_or_else(Vector3::zeros),
        matrix: Matrix3::from_diagonal(&datasheet.gain.unwrap_or_else(|| Vector3::repeat(1.0))),
    };
    let list = datasheet.parameter_list();
    let spreads = list.describe(datasheet, &sensor);
    for (quantity, parameter) in list.quantities().iter().zip(spreads) {
        let draw: f64 = StandardNormal.sample(rng);
        Quantity::add_to(*quantity, &mut sensor, draw * parameter.spread.unwrap_or(0.0));
    }
    sensor
}
