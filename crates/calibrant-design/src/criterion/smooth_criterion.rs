//! The criteria as smooth functions of the covariance, for the search.
//!
//! E and M are maxima, and have kinks where an optimal design lies. The search replaces a maximum of
//! positive numbers by its power mean `(Σ λ_i^q)^(1/q)`, which is at most `p^(1/q)` times as large. A, c, I
//! and D are smooth as they are. The logarithm makes all of them numbers without a unit.

use calibrant_core::information::Criterion;
use nalgebra::{DMatrix, DVector};

/// A criterion, and the exponent q that takes the place of a maximum.
#[derive(Clone, Copy)]
pub(crate) struct SmoothCriterion<'a> {
    pub(crate) criterion: &'a Criterion,
    pub(crate) exponent: f64,
}

impl SmoothCriterion<'_> {
    /// `ln Φ` (for D: `ln det C / p`), and its derivative with respect to C.
    pub(crate) fn at(&self, c: &DMatrix<f64>) -> (f64, DMatrix<f64>) {
        let size = c.nrows();
        match self.criterion {
            Criterion::D(_) => {
                let share = 1.0 / size as f64;
                (self.criterion.value(c) * share, self.criterion.derivative(c) * share)
            }
            Criterion::E(e) => {
                let scaled = DMatrix::from_fn(size, size, |i, j| c[(i, j)] / (e.scale[i] * e.scale[j]));
                let eigen = scaled.symmetric_eigen();
                let (value, shares) = self.power_mean(&eigen.eigenvalues);
                let mut vectors = eigen.eigenvectors;
                for (mut row, scale) in vectors.row_iter_mut().zip(e.scale.iter()) {
                    row /= *scale;
                }
                (value, &vectors * DMatrix::from_diagonal(&shares) * vectors.transpose())
            }
            Criterion::M(m) => {
                let squares = m.scale.component_mul(&m.scale);
                let (value, shares) = self.power_mean(&c.diagonal().component_div(&squares));
                (value, DMatrix::from_diagonal(&shares.component_div(&squares)))
            }
            Criterion::A(_) | Criterion::C(_) | Criterion::I(_) => {
                let value = self.criterion.value(c);
                (value.ln(), self.criterion.derivative(c) / value)
            }
        }
    }

    /// `ln (Σ λ^q)^(1/q)`, and its derivative with respect to each λ.
    fn power_mean(&self, values: &DVector<f64>) -> (f64, DVector<f64>) {
        let largest = values.max();
        let powers = values.map(|value| (value.max(0.0) / largest).powf(self.exponent));
        let sum = powers.sum();
        let value = largest.ln() + sum.ln() / self.exponent;
        (value, powers.zip_map(values, |power, value| power / (value.max(f64::MIN_POSITIVE) * sum)))
    }
}
