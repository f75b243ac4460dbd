//! The turns between poses, and what they tell of a gyroscope.
//!
//! Between two holds the sensor is turned by the shortest way, about the axis `e ∝ u_j × u_i` by the angle θ
//! between the directions. The gyroscope's readings, integrated from the first hold, predict the direction in
//! the second. An error E of the gyroscope's matrix changes the prediction by
//!
//! `δu = [u_j]ₓ B E e`, `B = ∫₀^θ exp(−[e]ₓ s) ds = θ e eᵀ + sin θ (I − e eᵀ) − (1 − cos θ) [e]ₓ`,
//!
//! so the turn has the information `Bᵀ (I − u_j u_jᵀ) B ⊗ e eᵀ` on E, per variance of the prediction. A turn
//! shows the column of E along its axis alone, so the axes must span the space. A half turn has no axis of its own, and
//! counts as nothing.

use nalgebra::{Matrix3, SMatrix, Vector3};

/// Standard deviation of the error of the gyroscope's matrix before the calibration.
const PRIOR: f64 = 0.05;
/// Standard deviation of a predicted direction, rad.
const PREDICTED: f64 = 1e-3;

/// The mean of all turns from z up on, rad.
pub(super) fn mean_turn(order: &[Vector3<f64>]) -> f64 {
    // before the first pose the sensor lies on the table
    let begin = order.first().map_or(0.0, |first| first.angle(&Vector3::z()));
    (begin + order.windows(2).map(|pair| pair[0].angle(&pair[1])).sum::<f64>()) / order.len().max(1) as f64
}

/// `tr (Λ + Σ m_turn)⁻¹`: sum of the variances of the entries of the gyroscope's matrix after these turns.
pub(super) fn gyroscope_variance(order: &[Vector3<f64>]) -> f64 {
    let mut information = SMatrix::<f64, 9, 9>::identity() / (PRIOR * PRIOR);
    for pair in order.windows(2) {
        information += turn_information(&pair[0], &pair[1]) / (PREDICTED * PREDICTED);
    }
    information.cholesky().map_or(f64::INFINITY, |cholesky| cholesky.inverse().trace())
}

/// The information of a turn on the entries of E, row by row, per variance of the prediction.
fn turn_information(from: &Vector3<f64>, to: &Vector3<f64>) -> SMatrix<f64, 9, 9> {
    let angle = from.angle(to);
    // the hand chooses the axis of a half turn
    let Some(e) = to.cross(from).try_normalize(1e-9) else { return SMatrix::zeros() };
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
    use crate::poses::Allowed;
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

    /// A gyroscope that turns about one axis alone shows one column of its matrix.
    #[test]
    fn turns_about_one_axis_leave_six_entries_to_the_prior() {
        let flat: Vec<_> = (0..8)
            .map(|k| {
                let turn = f64::from(k) * std::f64::consts::FRAC_PI_4;
                Vector3::new(turn.cos(), turn.sin(), 0.0)
            })
            .collect();
        let prior = PRIOR * PRIOR;
        assert!(gyroscope_variance(&flat) > 6.0 * prior);
        let Allowed::Of(cube) = Allowed::cube(true, true) else { panic!("a list") };
        assert!(gyroscope_variance(&cube) < 0.1 * prior, "{}", gyroscope_variance(&cube) / prior);
    }

    #[test]
    fn the_mean_turn_of_a_circle_is_its_step() {
        let circle: Vec<_> = (0..8)
            .map(|k| {
                let turn = f64::from(k) * std::f64::consts::FRAC_PI_4;
                Vector3::new(0.0, turn.sin(), turn.cos())
            })
            .collect();
        assert!((mean_turn(&circle) - 7.0 / 8.0 * std::f64::consts::FRAC_PI_4).abs() < 1e-12);
    }
}
