//! Which way is up, by a reading: with the calibration so far, or with the nominal gain and offset.

use calibrant_core::sensor::{ReadingUnit, Sensor, SensorParameters};
use nalgebra::Vector3;

/// A magnitude that is nearly gravity's, as a share of it.
const NEARLY: f64 = 0.5;
const GRAVITY: f64 = 9.806_65;

/// The accelerometer as far as it is known.
#[derive(Debug, Clone)]
pub(crate) struct KnownForce {
    gain: Option<Vector3<f64>>,
    offset: Vector3<f64>,
    pub(crate) calibrated: Option<SensorParameters>,
}

impl KnownForce {
    pub(crate) fn new(sensor: &Sensor, unit: ReadingUnit) -> Self {
        let gain = if unit == ReadingUnit::Counts { sensor.gain } else { Some(Vector3::repeat(1.0)) };
        Self { gain, offset: sensor.offset.unwrap_or_default(), calibrated: None }
    }

    /// Gravity in the unit of the readings, where a gain is known.
    pub(crate) fn gravity(&self) -> Option<f64> {
        self.gain.map(|gain| gain.abs().mean() * GRAVITY)
    }

    /// The direction of the specific force; `None` where a reading does not tell it, as counts whose offset nobody knows.
    pub(crate) fn up(&self, reading: &Vector3<f64>) -> Option<Vector3<f64>> {
        let by = |sensor: &SensorParameters| Some(sensor.matrix.try_inverse()? * (reading - sensor.bias));
        if let Some(force) = self.calibrated.as_ref().and_then(by) {
            return force.try_normalize(0.0);
        }
        let force = (reading - self.offset).component_div(&self.gain?);
        let is_near = (force.norm() / GRAVITY - 1.0).abs() < NEARLY;
        is_near.then(|| force.normalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant::io::{Experiment, preset};

    #[test]
    fn an_offset_that_nobody_knows_leaves_the_direction_open_until_it_is_calibrated() {
        let experiment = Experiment::parse(preset("imu").expect("built in"), None).expect("valid");
        let counts = Sensor { gain: Some(Vector3::repeat(415.0)), ..experiment.sensor };
        let mut force = KnownForce::new(&counts, ReadingUnit::Counts);
        let reading = Vector3::new(33_100.0, 33_300.0, 36_430.0);
        assert_eq!(force.up(&reading), None);
        let matrix = nalgebra::Matrix3::from_diagonal_element(415.0);
        force.calibrated = Some(SensorParameters::linear(Vector3::new(33_124.0, 33_276.0, 32_360.0), matrix));
        assert!(force.up(&reading).is_some_and(|up| up.z > 0.99));
        assert!((force.gravity().expect("a gain") - 4069.8).abs() < 0.1);
        let si = KnownForce::new(&counts, ReadingUnit::MetrePerSecondSquared);
        assert!(si.up(&Vector3::new(0.0, 0.9, 8.9)).is_some());
    }
}
