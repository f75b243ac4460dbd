//! A linear fit of the readings of an axis in a motion, whose residuals are comparable: each over the share of its standard deviation that the fit leaves.
//!
//! `r_k/√(1 − h_k)`, with the leverage `h_k = x_kᵀ (XᵀX)⁻¹ x_k` of the sample. All have the standard deviation of the noise (`baarda1968`).

use super::holds::median;
use crate::motion::CommandedMotion;
use nalgebra::{Matrix4, Vector4};

/// A sample of whose residual less than this is left has nothing to check it.
const LEAST_REDUNDANCY: f64 = 1e-3;
/// A node without samples, or an axis that is not moved, is held by this share of what holds the others.
const HELD: f64 = 1e-9;

/// The unknowns on which a sample depends, with their factors.
type Row = [(usize, f64); 4];

/// A linear fit.
pub(super) struct StudentisedFit {
    rows: Vec<Row>,
    normal: Normal,
}

/// The normal equations, solved for any right-hand side.
enum Normal {
    /// By a constant and three gains: the inverse.
    Full(Box<Matrix4<f64>>),
    /// By a line with corners.
    Tridiagonal(Tridiagonal),
}

/// A symmetric tridiagonal matrix as `L D Lᵀ`, and the entries of its inverse on and beside the diagonal.
struct Tridiagonal {
    pivots: Vec<f64>,
    lower: Vec<f64>,
    inverse_diagonal: Vec<f64>,
    inverse_beside: Vec<f64>,
}

impl StudentisedFit {
    /// By the commanded motion: a constant, and a gain for each of its axes.
    pub(super) fn of_known(command: &CommandedMotion, times_s: &[f64]) -> Option<Self> {
        let row = |t: &f64| {
            let acceleration = command.motion.acceleration_at(*t);
            [(0, 1.0), (1, acceleration.x), (2, acceleration.y), (3, acceleration.z)]
        };
        let rows: Vec<Row> = times_s.iter().map(row).collect();
        let mut normal = Matrix4::zeros();
        for row in &rows {
            let factors = Vector4::from_fn(|k, _| row[k].1);
            normal += factors * factors.transpose();
        }
        let held = HELD * normal.trace();
        let inverse = (normal + Matrix4::from_diagonal_element(held)).cholesky()?.inverse();
        Some(Self { rows, normal: Normal::Full(Box::new(inverse)) })
    }

    /// By a line with a corner at each node.
    pub(super) fn of_corners(command: &CommandedMotion, times_s: &[f64]) -> Option<Self> {
        let row = |t: &f64| {
            let (interval, part) = command.motion.locate(*t);
            [(interval, 1.0 - part), (interval + 1, part), (0, 0.0), (0, 0.0)]
        };
        let rows: Vec<Row> = times_s.iter().map(row).collect();
        let nodes = command.motion.intervals() + 1;
        let (mut diagonal, mut beside) = (vec![0.0; nodes], vec![0.0; nodes - 1]);
        for [(first, before), (second, after), ..] in &rows {
            diagonal[*first] += before * before;
            diagonal[*second] += after * after;
            beside[*first] += before * after;
        }
        let held = HELD * diagonal.iter().sum::<f64>() / nodes as f64;
        diagonal.iter_mut().for_each(|entry| *entry += held);
        Some(Self { rows, normal: Normal::Tridiagonal(Tridiagonal::of(diagonal, &beside)?) })
    }

    /// The residuals of these readings; 0 where the fit leaves nothing.
    pub(super) fn residuals(&self, readings: &[f64]) -> Vec<f64> {
        // about the middle of the readings, so that what holds an unknown does not matter
        let middle = median(readings.to_vec());
        let unknowns = match &self.normal {
            Normal::Full(_) => 4,
            Normal::Tridiagonal(matrix) => matrix.pivots.len(),
        };
        let mut right = vec![0.0; unknowns];
        for (row, reading) in self.rows.iter().zip(readings) {
            row.iter().for_each(|(k, factor)| right[*k] += factor * (reading - middle));
        }
        let solution = self.normal.solve(right);
        let residual = |(row, reading): (&Row, &f64)| {
            let fitted: f64 = row.iter().map(|(k, factor)| factor * solution[*k]).sum();
            let left = 1.0 - self.normal.leverage(row);
            if left > LEAST_REDUNDANCY { (reading - middle - fitted) / left.sqrt() } else { 0.0 }
        };
        self.rows.iter().zip(readings).map(residual).collect()
    }
}

impl Normal {
    fn solve(&self, right: Vec<f64>) -> Vec<f64> {
        match self {
            Self::Full(inverse) => (**inverse * Vector4::from_column_slice(&right)).iter().copied().collect(),
            Self::Tridiagonal(matrix) => matrix.solve(right),
        }
    }

    fn leverage(&self, row: &Row) -> f64 {
        match self {
            Self::Full(inverse) => {
                let factors = Vector4::from_fn(|k, _| row[k].1);
                (factors.transpose() * **inverse * factors)[(0, 0)]
            }
            Self::Tridiagonal(matrix) => {
                let [(first, before), (second, after), ..] = *row;
                before * before * matrix.inverse_diagonal[first]
                    + after * after * matrix.inverse_diagonal[second]
                    + 2.0 * before * after * matrix.inverse_beside[first]
            }
        }
    }
}

impl Tridiagonal {
    /// `None` where the matrix is not positive.
    fn of(mut pivots: Vec<f64>, beside: &[f64]) -> Option<Self> {
        let mut lower = vec![0.0; beside.len()];
        for k in 0..beside.len() {
            lower[k] = beside[k] / pivots[k];
            pivots[k + 1] -= lower[k] * beside[k];
        }
        if pivots.iter().any(|pivot| pivot.is_nan() || *pivot <= 0.0) {
            return None;
        }
        let mut inverse_diagonal: Vec<f64> = pivots.iter().map(|pivot| 1.0 / pivot).collect();
        let mut inverse_beside = vec![0.0; beside.len()];
        for k in (0..beside.len()).rev() {
            inverse_beside[k] = -lower[k] * inverse_diagonal[k + 1];
            inverse_diagonal[k] -= lower[k] * inverse_beside[k];
        }
        Some(Self { pivots, lower, inverse_diagonal, inverse_beside })
    }

    fn solve(&self, mut right: Vec<f64>) -> Vec<f64> {
        let last = self.lower.len();
        for k in 0..last {
            right[k + 1] -= self.lower[k] * right[k];
        }
        right.iter_mut().zip(&self.pivots).for_each(|(entry, pivot)| *entry /= pivot);
        for k in (0..last).rev() {
            right[k] -= self.lower[k] * right[k + 1];
        }
        right
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn the_tridiagonal_inverse_is_that_of_dense_algebra() {
        let (diagonal, beside) = (vec![2.0, 3.0, 2.5, 4.0], [0.5, -0.7, 1.1]);
        let dense = DMatrix::from_fn(4, 4, |i, j| match i.abs_diff(j) {
            0 => diagonal[i],
            1 => beside[i.min(j)],
            _ => 0.0,
        });
        let inverse = dense.try_inverse().expect("positive");
        let found = Tridiagonal::of(diagonal, &beside).expect("positive");
        let solution = found.solve(vec![1.0, -2.0, 0.5, 3.0]);
        let expected = &inverse * DVector::from_vec(vec![1.0, -2.0, 0.5, 3.0]);
        for k in 0..4 {
            assert!((found.inverse_diagonal[k] - inverse[(k, k)]).abs() < 1e-14, "{k}");
            assert!((solution[k] - expected[k]).abs() < 1e-14, "{k}");
        }
        for k in 0..3 {
            assert!((found.inverse_beside[k] - inverse[(k, k + 1)]).abs() < 1e-14, "{k}");
        }
    }
}
