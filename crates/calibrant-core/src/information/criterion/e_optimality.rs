//! Criterion E: the variance of the worst direction.

use super::scaling::scaled;
use nalgebra::{DMatrix, DVector};

/// Largest eigenvalue of the covariance: the variance of the worst-determined combination of parameters.
///
/// `Φ_E(C) = λ_max(C_ij / (s_i s_j))`
///
/// The longest half-axis of the confidence ellipsoid is proportional to `√Φ_E`. Not smooth where the largest eigenvalue is a double one, as optimal
/// designs often make it.
///
/// # Units
/// None with a scale. Mixed without one, so a scale is advisable.
///
/// # References
/// `pukelsheim2006`
#[derive(Debug, Clone, PartialEq)]
pub struct EOptimality {
    /// The divisor of each parameter.
    pub scale: DVector<f64>,
}

impl EOptimality {
    pub(super) fn value(&self, covariance: &DMatrix<f64>) -> f64 {
        scaled(covariance, &self.scale).symmetric_eigenvalues().max()
    }

    pub(super) fn derivative(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        let eigen = scaled(covariance, &self.scale).symmetric_eigen();
        let v = eigen.eigenvectors.column(eigen.eigenvalues.imax()).component_div(&self.scale);
        &v * v.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn e_is_the_largest_eigenvalue() {
        let c = super::super::by_hand();
        assert!((EOptimality { scale: DVector::repeat(2, 1.0) }.value(&c) - 6.0).abs() < 1e-14);
    }
}
