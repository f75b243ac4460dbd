//! Derivatives of an orientation spline with respect to its control points.
//!
//! A control point moves by `R_j exp(δ_j)`. Orientation moves by `R exp(θ)`. With `A = exp(λ d)` and a change `δd` of one rotation vector,
//! `θ = λ J_r(λd) δd`, `δω = (Aᵀω)×θ + λ̇ δd`, `δω̇ = (Aᵀω̇)×θ + λ̇ (δω×d + ω×δd) + λ̈ δd`; later factors turn these and add `λ̇ δω×d`.
//! A rotation vector changes by `δd_j = J_r⁻¹(d_j) δ_j − J_l⁻¹(d_j) δ_{j−1}`.
//!
//! Derivatives of the exponential map of rotations.
//!
//! `exp(v + δ) = exp(v) exp(J_r(v) δ) = exp(J_l(v) δ) exp(v)` to first order in `δ` (`sola2018`).

use super::vector_spline::{RotationAt, RotationSpline, cumulative};
use super::{LARGEST_ORDER, Weights};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// Derivatives with respect to one control point.
#[derive(Debug, Clone, Copy)]
pub struct OfControl {
    /// Of the orientation, as a turn about the axes of the body.
    pub turn: Matrix3<f64>,
    /// Of the angular rate, 1/s.
    pub rate: Matrix3<f64>,
    /// Of the angular acceleration, 1/s².
    pub acceleration: Matrix3<f64>,
}

impl OfControl {
    fn zeros() -> Self {
        let zero = Matrix3::zeros();
        Self { turn: zero, rate: zero, acceleration: zero }
    }

    /// What a later factor `exp(λ d)` makes of them.
    fn through(&self, a_transposed: &Matrix3<f64>, d: &Matrix3<f64>, l1: f64) -> Self {
        let rate = a_transposed * self.rate;
        Self {
            turn: a_transposed * self.turn,
            rate,
            acceleration: a_transposed * self.acceleration - d * rate * l1,
        }
    }

    fn add(&mut self, of_difference: &Self, difference: &Matrix3<f64>) {
        self.turn += of_difference.turn * difference;
        self.rate += of_difference.rate * difference;
        self.acceleration += of_difference.acceleration * difference;
    }
}

/// An orientation with its derivatives.
#[derive(Debug, Clone)]
pub struct RotationSensitivity {
    /// The orientation and its motion.
    pub at: RotationAt,
    /// Derivatives with respect to the control points of the interval, in their order.
    pub controls: [OfControl; LARGEST_ORDER],
}

/// The orientation with these weights, and its derivatives.
#[must_use]
pub fn rotation_sensitivity(spline: &RotationSpline, weights: &Weights) -> RotationSensitivity {
    let lambda: [_; 3] = std::array::from_fn(|m| cumulative(&weights.derivative[m], weights.order));
    let mut of = [OfControl::zeros(); LARGEST_ORDER];
    // of[0] is that of the first control point itself; of[r] that of the rotation vector before control point r
    of[0].turn = Matrix3::identity();
    let mut differences = [Vector3::zeros(); LARGEST_ORDER];
    let (mut omega, mut omega_dot) = (Vector3::zeros(), Vector3::zeros());
    for r in 1..weights.order {
        let [l0, l1, l2] = lambda.map(|of| of[r]);
        let d = spline.difference(weights.interval + r);
        differences[r] = d;
        let cross = skew(&d);
        let a_transposed =
            UnitQuaternion::from_scaled_axis(d * l0).inverse().to_rotation_matrix().into_inner();
        for earlier in &mut of[..r] {
            *earlier = earlier.through(&a_transposed, &cross, l1);
        }
        let (turned, turned_dot) = (a_transposed * omega, a_transposed * omega_dot);
        omega = turned + d * l1;
        omega_dot = turned_dot + omega.cross(&d) * l1 + d * l2;
        let turn = right_jacobian(&(d * l0)) * l0;
        let rate = skew(&turned) * turn + Matrix3::identity() * l1;
        let acceleration =
            skew(&turned_dot) * turn + (skew(&omega) - cross * rate) * l1 + Matrix3::identity() * l2;
        of[r] = OfControl { turn, rate, acceleration };
    }
    let mut controls = [OfControl::zeros(); LARGEST_ORDER];
    controls[0] = of[0];
    for r in 1..weights.order {
        controls[r].add(&of[r], &right_jacobian_inverse(&differences[r]));
        controls[r - 1].add(&of[r], &-left_jacobian_inverse(&differences[r]));
    }
    RotationSensitivity { at: spline.with(weights), controls }
}

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
    use super::super::{Degree, UniformKnots};
    use super::*;
    use nalgebra::UnitQuaternion;

    fn wild(degree: Degree) -> RotationSpline {
        let knots = UniformKnots { start_s: 1.0, step_s: 0.3, intervals: 6, degree };
        let turn = |i: usize| {
            let t = i as f64;
            Vector3::new((1.3 * t).sin(), 0.7 * (2.1 * t).cos(), 0.4 * t)
        };
        let controls = (0..knots.controls()).map(|i| UnitQuaternion::from_scaled_axis(turn(i))).collect();
        RotationSpline { knots, controls }
    }

    #[test]
    fn each_time_derivative_is_that_of_the_one_before() {
        for degree in [Degree::Cubic, Degree::Quintic] {
            let (spline, eps) = (wild(degree), 1e-5);
            let [before, at, after] = [-eps, 0.0, eps].map(|e| spline.at(1.77 + e));
            let turned = (before.world_from_body.inverse() * after.world_from_body).scaled_axis();
            for (slope, exact) in [
                (turned, at.rate),
                (after.rate - before.rate, at.acceleration),
                (after.acceleration - before.acceleration, at.jerk),
            ] {
                assert!(
                    (slope / (2.0 * eps) - exact).norm() < 1e-7 * (1.0 + exact.norm()),
                    "{slope} {exact}"
                );
            }
        }
    }

    #[test]
    fn derivatives_by_control_points_are_differences() {
        for degree in [Degree::Cubic, Degree::Quintic] {
            let (spline, eps) = (wild(degree), 1e-6);
            let weights = spline.knots.weights(1.91);
            let exact = rotation_sensitivity(&spline, &weights);
            for r in 0..degree.order() {
                for axis in 0..3 {
                    let moved = |sign: f64| {
                        let mut step = Vector3::zeros();
                        step[axis] = sign * eps;
                        let mut spline = spline.clone();
                        spline.controls[weights.interval + r] *= UnitQuaternion::from_scaled_axis(step);
                        spline.with(&weights)
                    };
                    let (one, other) = (moved(-1.0), moved(1.0));
                    let turn = (one.world_from_body.inverse() * other.world_from_body).scaled_axis();
                    let of = &exact.controls[r];
                    for (difference, exact) in [
                        (turn, of.turn.column(axis)),
                        (other.rate - one.rate, of.rate.column(axis)),
                        (other.acceleration - one.acceleration, of.acceleration.column(axis)),
                    ] {
                        let error = (difference / (2.0 * eps) - exact).norm();
                        assert!(error < 1e-7 * (1.0 + exact.norm()), "{degree:?} {r} {axis}: {error}");
                    }
                }
            }
        }
    }

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
