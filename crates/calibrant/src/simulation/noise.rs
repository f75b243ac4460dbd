//! The noise of a simulated sensor.

use calibrant_core::sensor::SensorKind;
use nalgebra::Vector3;

/// The simulation has one noise for all axes of a sensor: the largest.
pub(super) fn one_for_all(sensor_kind: SensorKind, noise: &Vector3<f64>, remarks: &mut Vec<String>) -> f64 {
    if noise.max() > noise.min() {
        remarks.push(format!("the noise of the {sensor_kind} is simulated with that of its noisiest axis"));
    }
    noise.max()
}
