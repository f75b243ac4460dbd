//! The arc from one direction to another: the logarithm on the sphere, with its derivatives.
//!
//! For unit vectors `u` and `t` at an angle θ, the arc is `θ n`, with `n` the direction across `t` in which `u` lies. The projection of `u` across `t`,
//! `sin θ n`, agrees with it for small angles. But it is zero again at 180°, and a rotation that ends upside down would fit.

use crate::estimate::tangent_plane::tangents;
use nalgebra::{Matrix2, Matrix2x3, Vector2, Vector3};

/// Least `sin θ` in the derivative of `n`. Near 180° this derivative grows without bound.
const LEAST_SINE: f64 = 0.05;

/// The arc from a direction to another.
pub(crate) struct Arc {
    /// `θ n` in the tangent plane of the target direction, rad.
    pub(crate) error: Vector2<f64>,
    /// Derivative with respect to `u`, a unit vector.
    pub(crate) by_missing: Matrix2x3<f64>,
    /// Derivative with respect to a rotation of the target direction along its tangents.
    pub(crate) by_missed: Matrix2<f64>,
}

impl Arc {
    /// `missing` is `u`, and `missed` the target `t`. Both are unit vectors.
    pub(crate) fn of(missing: &Vector3<f64>, missed: &Vector3<f64>) -> Self {
        let across = tangents(missed);
        let part = across.tr_mul(missing);
        let (sin, cos) = (part.norm(), missing.dot(missed));
        let angle = sin.atan2(cos);
        let along = if sin > f64::EPSILON { part / sin } else { Vector2::x() };
        let beside = Vector2::new(-along.y, along.x);
        // θ / sin θ, 1 for small angles
        let segment = match (cos > 0.0, sin > f64::EPSILON) {
            (true, true) => angle / sin,
            (true, false) => 1.0,
            (false, _) => angle / sin.max(LEAST_SINE),
        };
        let onward = across * along * cos - missed * sin;
        Self {
            error: along * angle,
            by_missing: along * onward.transpose() + beside * (across * beside).transpose() * segment,
            by_missed: -along * along.transpose() - beside * beside.transpose() * (segment * cos),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Unit, UnitQuaternion};

    fn pair(degrees: f64) -> (Vector3<f64>, Vector3<f64>) {
        let missed = Vector3::new(0.48, -0.6, 0.64);
        let axis = Unit::new_normalize(tangents(&missed) * Vector2::new(0.8, 0.6));
        (UnitQuaternion::from_axis_angle(&axis, degrees.to_radians()) * missed, missed)
    }

    #[test]
    fn its_length_is_the_angle_up_to_half_a_turn() {
        for degrees in [0.0, 1e-9, 0.12, 30.0, 89.999, 90.0, 120.0, 179.0, 180.0] {
            let (missing, missed) = pair(degrees);
            let length = Arc::of(&missing, &missed).error.norm().to_degrees();
            assert!((length - degrees).abs() < 1e-9, "{degrees}: {length}");
        }
    }

    #[test]
    fn its_derivatives_are_those_of_differences() {
        const H: f64 = 1e-6;
        for degrees in [1e-4, 0.12, 30.0, 90.0, 120.0, 170.0] {
            let (missing, missed) = pair(degrees);
            let arc = Arc::of(&missing, &missed);
            for turn in [Vector3::x(), Vector3::y(), Vector3::z()] {
                let turned = |by: f64| UnitQuaternion::from_scaled_axis(turn * by) * missing;
                let change =
                    (Arc::of(&turned(H), &missed).error - Arc::of(&turned(-H), &missed).error) / (2.0 * H);
                let error = (change - arc.by_missing * turn.cross(&missing)).norm();
                assert!(error < 1e-7 * change.norm().max(1.0), "{degrees}: {error:e}");
            }
            // the same step of both, along the arc and across it, as far as the tangents do not turn
            let along = arc.error.normalize();
            let step = tangents(&missed) * along * H;
            let nearer = Arc::of(&missing, &(missed + step).normalize()).error.norm();
            let slope = (nearer - arc.error.norm()) / H;
            assert!((along.dot(&(arc.by_missed * along)) - slope).abs() < 1e-5, "{degrees}: {slope}");
        }
    }

    #[test]
    fn it_does_not_break_down_upside_down() {
        let (missing, missed) = pair(180.0);
        let arc = Arc::of(&missing, &missed);
        assert!(arc.by_missing.iter().chain(arc.by_missed.iter()).all(|entry| entry.abs() < 100.0));
        let same = Arc::of(&missed, &missed);
        assert!(same.error.norm() < 1e-15 && (same.by_missed + Matrix2::identity()).norm() < 1e-12);
    }
}
