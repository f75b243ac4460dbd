//! Earth's rate, and its components at a latitude.

use nalgebra::Vector3;

/// Earth's rate, rad/s (`nga2014`).
pub const EARTH_RATE_RADPS: f64 = 7.292_115e-5;

/// Earth's rate at a geographic latitude, `Ω (cos φ, 0, sin φ)` with x to the north and z up, rad/s. South of
/// the equator the latitude is negative, and so is the rate about the vertical.
///
/// # Examples
/// ```
/// use calibrant_core::motion::earth_rate;
/// assert!((earth_rate(-90.0).z + 7.292115e-5).abs() < 1e-20);
/// assert!((earth_rate(30.0).z / earth_rate(90.0).z - 0.5).abs() < 1e-12);
/// ```
#[must_use]
pub fn earth_rate(latitude_deg: f64) -> Vector3<f64> {
    let (sin, cos) = latitude_deg.to_radians().sin_cos();
    Vector3::new(cos, 0.0, sin) * EARTH_RATE_RADPS
}
