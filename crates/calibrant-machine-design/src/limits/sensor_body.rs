//! The body of the sensor, whose speed is limited.

use nalgebra::Vector3;

/// A sphere about the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorBody {
    /// Its centre in the axes of the tip, m.
    pub center_m: Vector3<f64>,
    /// Its radius, m.
    pub radius_m: f64,
}
