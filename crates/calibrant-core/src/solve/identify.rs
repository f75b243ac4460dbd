//! The information scaled to unit diagonal, which does not depend on the units of the parameters, and its condition number.

use nalgebra::{DMatrix, DVectorView, Dyn, SymmetricEigen};

/// The eigenvalues and eigenvectors of `F_ij/√(F_ii F_jj)`.
pub(crate) struct ScaledInformation(pub(crate) SymmetricEigen<f64, Dyn>);

impl ScaledInformation {
    pub(crate) fn of(information: &DMatrix<f64>) -> Self {
        let size = information.nrows();
        let scaled = DMatrix::from_fn(size, size, |i, j| {
            information[(i, j)] / (information[(i, i)] * information[(j, j)]).sqrt()
        });
        Self(scaled.symmetric_eigen())
    }

    /// Ratio of the largest eigenvalue to the smallest: 1 is best.
    pub(crate) fn condition_number(&self) -> f64 {
        self.0.eigenvalues.max() / self.0.eigenvalues.min().max(f64::MIN_POSITIVE)
    }

    /// The combination that is determined worst.
    pub(crate) fn weakest(&self) -> DVectorView<'_, f64> {
        self.0.eigenvectors.column(self.0.eigenvalues.imin())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_condition_does_not_depend_on_units() {
        // two unknowns with correlation ρ: eigenvalues 1 ± ρ, the weakest their difference
        let scale = [1.0, 1e-7];
        let f = DMatrix::from_fn(2, 2, |i, j| scale[i] * scale[j] * if i == j { 1.0 } else { 0.6 });
        let scaled = ScaledInformation::of(&f);
        assert!((scaled.condition_number() - 4.0).abs() < 1e-12, "{}", scaled.condition_number());
        assert!((scaled.weakest()[0] + scaled.weakest()[1]).abs() < 1e-12);
    }
}
