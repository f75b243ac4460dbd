//! Slope and second derivative of a smooth criterion (A, D, c, I) with respect to a short motion.
//!
//! With `Ω = C (∂Φ/∂C) C` and `Ω = R Rᵀ`, `C = L Lᵀ`,
//!
//! `dΦ = −⟨Ω, dF⟩`, `d²Φ = κ ‖Lᵀ dF R‖² − ⟨Ω, d²F⟩`, κ = 2, or 1 for D with `R = L`.
//!
//! The solver minimises a transformed criterion that grows in proportion to the information: `−1/Φ`, or
//! `−exp(−Φ/p)` for D. Its second derivative is smaller by `2 dΦ²/Φ`, or `dΦ²/p`. Doubling the information
//! halves a variance and no more, which makes Newton's method slow from a poor start; the transformation takes
//! that away. Both have the same optima.
//!
//! # The kinks of the noise
//! Noise in proportion to the jerk, `q = Δτ² (floor + ratio |u|)²`, has a kink of `2 floor ratio Δτ` per
//! increment at jerk zero. Slope and second derivative are those of the side on which the increment lies.

use super::part::Part;
use calibrant_core::information::{Criterion, Linearised};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};

/// The model of a criterion at a motion: `Φ + slope·δ + ½ δᵀ hessian δ + Σ kinks |u|`.
pub(super) struct SecondOrder<const D: usize> {
    /// Slope with respect to coordinate k of node i, at `i D + k`.
    pub(super) slope: DVector<f64>,
    /// Second derivative of the transformed criterion.
    pub(super) hessian: DMatrix<f64>,
    /// Weight of each increment's size at zero, at `i D + k`. Empty where there is no kink.
    pub(super) kinks: Vec<f64>,
}

impl<const D: usize, const P: usize> Part<D, P> {
    /// The model at a motion, its increments on the sides that `signs` tell. `None` for criteria that are not
    /// smooth, for motions of which nothing is known, and where the motion does not determine the parameters.
    pub(super) fn second_order(
        &self,
        a: &[SVector<f64, D>],
        signs: &[SVector<f64, D>],
    ) -> Option<SecondOrder<D>> {
        let at = self.information.linearise(a)?;
        let c = self.covariance(&at)?;
        let value = self.criterion.value(&c);
        let (factor, transformed) = match &self.criterion {
            Criterion::E(_) | Criterion::M(_) => return None,
            Criterion::D(_) => (1.0, 1.0 / P as f64),
            _ => (2.0, 2.0 / value),
        };
        let lower = c.clone().cholesky()?.unpack();
        let right = self.right_factor(&c, &lower)?;
        let omega = &right * right.transpose();
        let omega = SMatrix::<f64, P, P>::from_fn(|i, j| omega[(i, j)]);
        let left = SMatrix::<f64, P, P>::from_fn(|i, j| lower[(j, i)]);
        let right = SMatrix::<f64, P, P>::from_fn(|i, j| right[(i, j)]);

        let curvature = self.information.curvature(a, &at, signs)?;
        let mut forms = DMatrix::zeros(P * P, a.len() * D);
        for (mut column, first) in forms.column_iter_mut().zip(&curvature.first) {
            column.copy_from_slice((left * first * right).as_slice());
        }
        let (slope, kinks) = self.slope(a, &at, &omega, signs);
        let mut hessian = forms.transpose() * &forms * factor - curvature.second(&omega);
        hessian.ger(-transformed, &slope, &slope, 1.0);
        Some(SecondOrder { slope, hessian, kinks })
    }

    /// R with `Ω = R Rᵀ`.
    fn right_factor(&self, c: &DMatrix<f64>, lower: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        if let Criterion::D(_) = self.criterion {
            return Some(lower.clone());
        }
        let eigen = self.criterion.derivative(c).symmetric_eigen();
        let root = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
        Some(c * eigen.eigenvectors * DMatrix::from_diagonal(&root))
    }

    /// The slope on the sides that `signs` tell, and the kinks.
    fn slope(
        &self,
        a: &[SVector<f64, D>],
        at: &Linearised<D, P>,
        omega: &SMatrix<f64, P, P>,
        signs: &[SVector<f64, D>],
    ) -> (DVector<f64>, Vec<f64>) {
        let derivative = self.information.derivative(at, omega);
        let total = self.information.total_on_sides(a, &derivative, signs);
        let slope = DVector::from_fn(a.len() * D, |at, _| -total[at / D][at % D]);
        let mut kinks = Vec::new();
        if let Some((floor, ratio)) =
            self.information.input_noise().filter(|(floor, ratio)| floor * ratio > 0.0)
        {
            for (i, variance) in derivative.variances.iter().enumerate() {
                let dt = self.information.interval_s(i);
                kinks.extend(variance.iter().map(|variance| -variance * 2.0 * floor * dt * ratio));
            }
        }
        (slope, kinks)
    }
}
