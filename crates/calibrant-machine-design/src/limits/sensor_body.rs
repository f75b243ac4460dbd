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

impl SensorBody {
    /// Largest speed of a point of the sphere, m/s. Its centre has velocity `v`, and it turns with `w`: points off the centre add what is perpendicular to `w`.
    ///
    /// # Formula
    /// `max_{|x| ≤ r} |v + w × x| = √((|v⊥| + r|w|)² + v∥²)`.
    pub(crate) fn fastest_mps(&self, v: &Vector3<f64>, w: &Vector3<f64>) -> f64 {
        let axis = w.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let along = v.dot(&axis);
        ((v - axis * along).norm() + self.radius_m * w.norm()).hypot(along)
    }
}
