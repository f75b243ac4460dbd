//! Derivatives of the exponential map of rotations.
//!
//! `exp(v + δ) = exp(v) exp(J_r(v) δ) = exp(J_l(v) δ) exp(v)` to first order in `δ` (`sola2018`).

use nalgebra::{Matrix3, Vector3};

/// The matrix of the cross product: `skew(v) x = v × x`.
#[must_use]
pub fn skew(v: &Vector3<f64>) -> Matrix3<f64> {
    v.cross_matrix()
}

/// `I + a V + b V²` of the matrix `V` of `v`.
fn polynomial(v: &Vector3<f64>, a: f64, b: f64) -> Matrix3<f64> {
    let cross = skew(v);
    Matrix3::identity() + cross * a + cross * cross * b
}

/// `J_r(v)`.
#[must_use]
pub fn right_jacobian(v: &Vector3<f64>) -> Matrix3<f64> {
    let square = v.norm_squared();
    if square < 1e-8 {
        return polynomial(v, -0.5 + square / 24.0, 1.0 / 6.0 - square / 120.0);
    }
    let angle = square.sqrt();
    polynomial(v, -(1.0 - angle.cos()) / square, (angle - angle.sin()) / (square * angle))
}

/// `J_r(v)⁻¹`, for angles below 2π.
#[must_use]
pub fn right_jacobian_inverse(v: &Vector3<f64>) -> Matrix3<f64> {
    let square = v.norm_squared();
    if square < 1e-8 {
        return polynomial(v, 0.5, 1.0 / 12.0 + square / 720.0);
    }
    let half = 0.5 * square.sqrt();
    polynomial(v, 0.5, (1.0 - half / half.tan()) / square)
}

/// `J_l(v)⁻¹`, for angles below 2π.
#[must_use]
pub fn left_jacobian_inverse(v: &Vector3<f64>) -> Matrix3<f64> {
    right_jacobian_inverse(v).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

    #[test]
    fn the_jacobian_is_the_derivative_of_the_exponential() {
        for v in [Vector3::new(0.3, -0.8, 0.5), Vector3::new(1e-5, 2e-5, -1e-5), Vector3::new(1.9, 1.2, -1.0)]
        {
            let exp = |v: Vector3<f64>| UnitQuaternion::from_scaled_axis(v);
            for axis in 0..3 {
                let mut step = Vector3::zeros();
                step[axis] = 1e-6;
                let turned = (exp(v - step).inverse() * exp(v + step)).scaled_axis() / 2e-6;
                assert!((turned - right_jacobian(&v).column(axis)).norm() < 1e-9);
            }
            assert!((right_jacobian(&v) * right_jacobian_inverse(&v) - Matrix3::identity()).norm() < 1e-12);
        }
    }
}
