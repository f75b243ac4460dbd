//! The covariance of parameters: the inverse of their information.

use nalgebra::DMatrix;

/// Covariance `C = F⁻¹` of parameters with information `F`.
///
/// # Shapes and units
/// p × p; entry (i, j) of `F` in 1/(unit of θᵢ · unit of θⱼ), of `C` in unit of θᵢ · unit of θⱼ.
///
/// Returns `None` where `F` is not positive definite: then [`undetermined`](super::undetermined) names the
/// parameters at fault.
///
/// # Numerics
/// It takes the Cholesky factor of `F` scaled to unit diagonal, so that the units of the parameters do not
/// matter.
///
/// # Examples
/// ```
/// use calibrant_core::information::covariance;
/// use nalgebra::DMatrix;
/// let information = DMatrix::from_row_slice(2, 2, &[4.0, 2.0, 2.0, 2.0]);
/// let c = covariance(&information).unwrap();
/// assert!((c[(0, 0)] - 0.5).abs() < 1e-15 && (c[(0, 1)] + 0.5).abs() < 1e-15);
/// ```
#[must_use]
pub fn covariance(information: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = information.diagonal().map(|diagonal| 1.0 / diagonal.sqrt());
    if !scale.iter().all(|s| s.is_finite()) {
        return None;
    }
    let size = scale.len();
    let scaled = DMatrix::from_fn(size, size, |i, j| information[(i, j)] * scale[i] * scale[j]);
    let inverse = scaled.cholesky()?.inverse();
    Some(DMatrix::from_fn(size, size, |i, j| inverse[(i, j)] * scale[i] * scale[j]))
}
