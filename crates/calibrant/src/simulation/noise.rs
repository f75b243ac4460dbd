//! The noise of a simulated sensor.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::simulation::NoisiestAxis;
use calibrant_core::sensor::SensorKind;
use nalgebra::Vector3;

/// The simulation has one noise for all axes of a sensor: the largest.
pub(super) fn one_for_all(sensor_kind: SensorKind, noise: &Vector3<f64>, notes: &mut Vec<Diagnostic>) -> f64 {
    if noise.max() > noise.min() {
        notes.push(NoisiestAxis { sensor_kind }.into());
    }
    noise.max()
}
