//! The order of poses, by the turns between them.
//!
//! Between two holds the sensor is turned by the shortest way, about the axis `e ∝ u_j × u_i` by the angle θ
//! between the directions. The gyroscope's readings, integrated from the first hold, predict the direction in
//! the second. An error E of the gyroscope's matrix changes the prediction by
//!
//! `δu = [u_j]ₓ B E e`, `B = ∫₀^θ exp(−[e]ₓ s) ds = θ e eᵀ + sin θ (I − e eᵀ) − (1 − cos θ) [e]ₓ`,
//!
//! so the turn has the information `Bᵀ (I − u_j u_jᵀ) B ⊗ e eᵀ` on E, per variance of the prediction. The
//! order with the smallest `tr (Λ + Σ m_turn)⁻¹` is sought, with a prior Λ of five per cent. For an
//! accelerometer alone it is the order with the least turning.
//!
//! The order is improved by reversals of a part of it (2-opt) as long as one helps.

use super::allowed::perpendicular;
use nalgebra::{Matrix3, SMatrix, Vector3};

/// Standard deviation of the error of the gyroscope's matrix before the calibration.
const PRIOR: f64 = 0.05;
/// Standard deviation of a predicted direction, rad.
const PREDICTED: f64 = 1e-3;

/// The directions in the order in which to hold the sensor. `has_gyroscope`: the turns should determine a
/// gyroscope; otherwise they should be short.
#[must_use]
pub fn order_for_turns(directions: &[Vector3<f64>], has_gyroscope: bool) -> Vec<Vector3<f64>> {
    let cost = |order: &[Vector3<f64>]| {
        if has_gyroscope { gyroscope_variance(order) } else { turning(order) }
    };
    let mut order = nearest_next(directions);
    let mut least = cost(&order);
    let mut improved = true;
    while improved {
        improved = false;
        for first in 0..order.len() {
            for last in first + 1..order.len() {
                order[first..=last].reverse();
                let found = cost(&order);
                if found < least * (1.0 - 1e-9) {
                    least = found;
                    improved = true;
                } else {
                    order[first..=last].reverse();
                }
            }
        }
    }
    order
}

/// From the direction nearest to z up on, always to the nearest that is left.
fn nearest_next(directions: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    let mut left = directions.to_vec();
    let mut here = Vector3::z();
    let mut order = Vec::new();
    while !left.is_empty() {
        let next = (0..left.len()).min_by(|&a, &b| left[a].angle(&here).total_cmp(&left[b].angle(&here)));
        here = left.remove(next.unwrap_or(0));
        order.push(here);
    }
    order
}

/// The sum of all turns, rad.
fn turning(order: &[Vector3<f64>]) -> f64 {
    // the first pose is that of the sensor on the table
    let begin = order.first().map_or(0.0, |first| first.angle(&Vector3::z()));
    begin + order.windows(2).map(|pair| pair[0].angle(&pair[1])).sum::<f64>()
}

/// Sum of the variances of the entries of the gyroscope's matrix after these turns.
fn gyroscope_variance(order: &[Vector3<f64>]) -> f64 {
    let mut information = SMatrix::<f64, 9, 9>::identity() / (PRIOR * PRIOR);
    for pair in order.windows(2) {
        information += turn_information(&pair[0], &pair[1]) / (PREDICTED * PREDICTED);
    }
    information.cholesky().map_or(f64::INFINITY, |cholesky| cholesky.inverse().trace())
}

/// The information of a turn on the entries of E, row by row, per variance of the prediction.
fn turn_information(from: &Vector3<f64>, to: &Vector3<f64>) -> SMatrix<f64, 9, 9> {
    let angle = from.angle(to);
    let e = to.cross(from).try_normalize(1e-9).unwrap_or_else(|| perpendicular(from));
    let b = accumulated(&e, angle);
    let across = Matrix3::identity() - to * to.transpose();
    let left = b.tr_mul(&(across * b));
    SMatrix::from_fn(|i, j| left[(i / 3, j / 3)] * e[i % 3] * e[j % 3])
}

/// B.
fn accumulated(e: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let along = e * e.transpose();
    along * angle + (Matrix3::identity() - along) * angle.sin() - e.cross_matrix() * (1.0 - angle.cos())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    /// The prediction with a wrong matrix, by integration in small steps, against the formula.
    #[test]
    fn the_error_of_a_prediction_is_that_of_an_integration() {
        let from = Vector3::new(0.3, -0.5, 0.8).normalize();
        let to = Vector3::new(-0.7, 0.2, 0.4).normalize();
        let error = Matrix3::new(1.0, -2.0, 0.5, 0.3, 0.8, -1.0, 2.0, 0.1, -0.4) * 1e-6;
        let (angle, e) = (from.angle(&to), to.cross(&from).normalize());
        let steps = 20_000;
        let turn: Vector3<f64> = (Matrix3::<f64>::identity() + error) * e * (angle / f64::from(steps));
        let step = Rotation3::new(-turn);
        let mut predicted = from;
        for _ in 0..steps {
            predicted = step * predicted;
        }
        let expected = to.cross_matrix() * accumulated(&e, angle) * (error * e);
        assert!((predicted - to - expected).norm() < 1e-10, "{predicted} {to} {expected}");
    }

    #[test]
    fn turns_about_one_axis_alone_are_worse_for_a_gyroscope() {
        let flat: Vec<_> = (0..8)
            .map(|k| {
                let turn = f64::from(k) * std::f64::consts::FRAC_PI_4;
                Vector3::new(turn.cos(), turn.sin(), 0.0)
            })
            .collect();
        let cube = [1.0, -1.0].map(|s| [Vector3::x() * s, Vector3::y() * s, Vector3::z() * s]).concat();
        assert!(gyroscope_variance(&order_for_turns(&cube, true)) < gyroscope_variance(&flat));
    }

    #[test]
    fn the_shortest_order_of_a_circle_goes_round() {
        let circle: Vec<_> = [0, 4, 1, 6, 3, 7, 2, 5]
            .map(|k| {
                let turn = f64::from(k) * std::f64::consts::FRAC_PI_4;
                Vector3::new(0.0, turn.sin(), turn.cos())
            })
            .to_vec();
        let length = turning(&order_for_turns(&circle, false));
        assert!((length - 7.0 * std::f64::consts::FRAC_PI_4).abs() < 1e-9, "{length}");
    }
}
