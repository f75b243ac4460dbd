//! The two ways in which a direction can turn.

use nalgebra::{Matrix3x2, Vector3};

/// Two unit vectors perpendicular to `f` and to each other.
pub(super) fn tangents(f: &Vector3<f64>) -> Matrix3x2<f64> {
    let u = f.normalize();
    let other = if u.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let one = u.cross(&other).normalize();
    Matrix3x2::from_columns(&[one, u.cross(&one)])
}
