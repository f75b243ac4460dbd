//! Whitening: the transformation that makes correlated errors independent, of unit variance.

use nalgebra::{DMatrix, DVector, Dim, Matrix, RawStorage, StorageMut};

/// `W = L⁻¹ D⁻¹` with the covariance `Σ = D L Lᵀ D`, so that `W Σ Wᵀ = I` and `Wᵀ W = Σ⁻¹`. `D` holds the
/// standard deviations, as variances span many decades.
pub(super) struct Whitening {
    lower: DMatrix<f64>,
    /// Inverses of the standard deviations.
    scale: DVector<f64>,
}

impl Whitening {
    /// The whitening of independent errors of these variances.
    pub(super) fn of_independent(variances: impl ExactSizeIterator<Item = f64>) -> Self {
        let size = variances.len();
        let scale = DVector::from_iterator(size, variances.map(|variance| variance.sqrt().recip()));
        Self { lower: DMatrix::identity(size, size), scale }
    }

    /// The whitening of errors of this covariance; `None` where the matrix is not positive definite.
    pub(super) fn of_covariance(covariance: &DMatrix<f64>) -> Option<Self> {
        let scale = covariance.diagonal().map(|variance| variance.sqrt().recip());
        if scale.iter().any(|scale| !scale.is_finite()) {
            return None;
        }
        let correlation =
            DMatrix::from_fn(scale.len(), scale.len(), |i, j| covariance[(i, j)] * scale[i] * scale[j]);
        Some(Self { lower: correlation.cholesky()?.unpack(), scale })
    }

    /// `W M`.
    pub(super) fn whiten<C: Dim, S>(
        &self,
        mut matrix: Matrix<f64, nalgebra::Dyn, C, S>,
    ) -> Matrix<f64, nalgebra::Dyn, C, S>
    where
        S: StorageMut<f64, nalgebra::Dyn, C> + RawStorage<f64, nalgebra::Dyn, C>,
    {
        self.scale_rows(&mut matrix);
        self.lower.solve_lower_triangular_unchecked_mut(&mut matrix);
        matrix
    }

    /// `Wᵀ M`.
    pub(super) fn transposed(&self, mut matrix: DMatrix<f64>) -> DMatrix<f64> {
        self.lower.tr_solve_lower_triangular_unchecked_mut(&mut matrix);
        self.scale_rows(&mut matrix);
        matrix
    }

    fn scale_rows<C: Dim, S: StorageMut<f64, nalgebra::Dyn, C>>(
        &self,
        matrix: &mut Matrix<f64, nalgebra::Dyn, C, S>,
    ) {
        for mut column in matrix.column_iter_mut() {
            column.component_mul_assign(&self.scale);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_whitens() {
        let sigma = DMatrix::from_row_slice(3, 3, &[4e8, 10.0, 3e3, 10.0, 9e-6, 1e-4, 3e3, 1e-4, 1.0]);
        let white = Whitening::of_covariance(&sigma).expect("positive definite");
        let w = white.whiten(DMatrix::identity(3, 3));
        assert!((&w * &sigma * w.transpose() - DMatrix::identity(3, 3)).amax() < 1e-12);
        assert!((white.transposed(DMatrix::identity(3, 3)) - w.transpose()).amax() < 1e-12 * w.amax());
        let independent = Whitening::of_independent([4.0, 25.0].into_iter());
        assert_eq!(independent.whiten(DVector::from_element(2, 10.0)), DVector::from_vec(vec![5.0, 2.0]));
        assert!(Whitening::of_covariance(&DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 1.0])).is_none());
        assert!(Whitening::of_covariance(&DMatrix::zeros(2, 2)).is_none());
    }
}
