//! The IMU at a given temperature, and the list of its temperature terms.

use super::{Axis, HIGHEST_ORDER, ImuParameters, ImuQuantity, SensorKind, Thermal, ThermalPart, ThermalTerm};
use nalgebra::Matrix3;

impl ImuParameters {
    /// The IMU at a temperature: `b(T)`, `S(T)` and `Γ`. The result does not follow temperature any more.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::ImuParameters;
    /// let mut imu = ImuParameters::identity();
    /// imu.thermal.reference_c = 20.0;
    /// imu.thermal.gyroscope.bias[0].x = 1e-4; // rad/s/K
    /// imu.thermal.accelerometer.scale[1].z = 2e-6; // 1/K²
    /// let hot = imu.at(50.0);
    /// assert!((hot.gyroscope.bias.x - 3e-3).abs() < 1e-15);
    /// assert!((hot.accelerometer.matrix[(2, 2)] - 1.0018).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn at(&self, temperature_c: f64) -> Self {
        if self.thermal.is_none() {
            return *self;
        }
        let tau_k = self.thermal.tau_k(temperature_c);
        let mut imu = Self { thermal: Thermal::none(), ..*self };
        for sensor_kind in SensorKind::ALL {
            let (thermal, sensor) = (self.thermal.sensor(sensor_kind), imu.sensor_mut(sensor_kind));
            sensor.bias += thermal.bias_change(tau_k);
            sensor.matrix = Matrix3::from_diagonal(&thermal.gain_factor(tau_k)) * sensor.matrix;
        }
        imu
    }
}

impl ImuQuantity {
    /// The temperature terms of one sensor up to these orders. The terms of the bias come first, then those
    /// of the scale, order by order.
    #[must_use]
    pub fn thermal_list(sensor_kind: SensorKind, bias_order: usize, scale_order: usize) -> Vec<Self> {
        let mut list = Vec::new();
        for (part, order) in [(ThermalPart::Bias, bias_order), (ThermalPart::Scale, scale_order)] {
            for order in 1..=order.min(HIGHEST_ORDER) {
                list.extend(
                    Axis::ALL.map(|axis| Self::Thermal(sensor_kind, ThermalTerm { part, axis, order })),
                );
            }
        }
        list
    }

    /// Every temperature term of the sensors that are there.
    #[must_use]
    pub fn all_thermal(accelerometer: bool, gyroscope: bool) -> Vec<Self> {
        [(SensorKind::Accelerometer, accelerometer), (SensorKind::Gyroscope, gyroscope)]
            .into_iter()
            .filter(|(_, there)| *there)
            .flat_map(|(sensor_kind, _)| Self::thermal_list(sensor_kind, HIGHEST_ORDER, HIGHEST_ORDER))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::{Condition, ReadingUnit};
    use nalgebra::Vector3;

    #[test]
    fn names_and_units_say_the_power() {
        let list = ImuQuantity::thermal_list(SensorKind::Gyroscope, 2, 1);
        let names: Vec<String> = list.iter().map(|quantity| quantity.name()).collect();
        assert_eq!(names[0], "gyroscope.bias_per_k.x");
        assert_eq!(names[4], "gyroscope.bias_per_k2.y");
        assert_eq!(names[8], "gyroscope.scale_per_k.z");
        assert_eq!(list[4].unit(ReadingUnit::Counts), "counts/K²");
        assert_eq!(ImuQuantity::all_thermal(true, true).len(), 24);
    }

    #[test]
    fn derivatives_equal_differences() {
        let mut imu = ImuParameters::identity();
        let mut all = ImuQuantity::full_list(true, true, true);
        all.extend(ImuQuantity::all_thermal(true, true));
        for (k, quantity) in all.iter().enumerate() {
            quantity.add_to(&mut imu, 1e-3 * ((5 * k % 13) as f64 - 6.0));
        }
        let (stimulus, force, temperature_c) =
            (Vector3::new(0.4, -1.2, 0.3), Vector3::new(1.0, -5.0, 8.0), 29.5);
        let reading = |imu: &ImuParameters, sensor_kind: SensorKind| {
            let felt = if sensor_kind == SensorKind::Gyroscope {
                imu.g_sensitivity * force
            } else {
                Vector3::zeros()
            };
            imu.at(temperature_c).sensor(sensor_kind).reading(&stimulus) + felt
        };
        for quantity in all {
            let moved = |by: f64| {
                let mut moved = imu;
                quantity.add_to(&mut moved, by);
                reading(&moved, quantity.sensor_kind())
            };
            let difference = (moved(1e-4) - moved(-1e-4)) / 2e-4;
            let at = Condition { imu: &imu, stimulus, force, temperature_c };
            assert!((difference - quantity.derivative(&at)).amax() < 1e-8, "{}", quantity.name());
        }
    }

    #[test]
    fn each_term_is_found_where_it_was_added() {
        for (k, quantity) in ImuQuantity::all_thermal(true, true).into_iter().enumerate() {
            let mut imu = ImuParameters::identity();
            quantity.add_to(&mut imu, 1.0 + k as f64);
            let found: Vec<f64> =
                ImuQuantity::all_thermal(true, true).iter().map(|other| other.value(&imu)).collect();
            assert_eq!(found.iter().sum::<f64>(), 1.0 + k as f64);
            assert_eq!(found[k], 1.0 + k as f64, "{}", quantity.name());
        }
    }
}
