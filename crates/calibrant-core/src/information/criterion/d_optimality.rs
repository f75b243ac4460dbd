//! Criterion D: the volume of the confidence ellipsoid.

use super::scaling::scaled;
use nalgebra::{Cholesky, DMatrix, DVector};

/// Logarithm of the generalised variance.
///
/// `Φ_D(C) = ln det C − 2 Σ ln s_i`
///
/// The confidence ellipsoid's volume is proportional to `exp(Φ_D/2)`. Changing a parameter's unit (or `s`)
/// adds a constant and leaves the optimal design where it was. This is not so for A, E and M.
///
/// # Units
/// Nats. Compare only designs of the same parameters, by difference.
///
/// # Numerics
/// It is twice the sum of the logarithms of the Cholesky diagonal: the determinant itself underflows.
///
/// # References
/// `pukelsheim2006`
#[derive(Debug, Clone, PartialEq)]
pub struct DOptimality {
    /// The divisor of each parameter.
    pub scale: DVector<f64>,
}

impl DOptimality {
    pub(super) fn value(&self, covariance: &DMatrix<f64>) -> f64 {
        Cholesky::new(scaled(covariance, &self.scale)).map_or(f64::NAN, |cholesky| {
            2.0 * cholesky.l_dirty().diagonal().iter().map(|d| d.ln()).sum::<f64>()
        })
    }

    pub(super) fn derivative(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        crate::information::covariance(covariance)
            .unwrap_or_else(|| DMatrix::from_element(self.scale.len(), self.scale.len(), f64::NAN))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn d_is_the_log_determinant_and_units_add_a_constant() {
        let c = super::super::by_hand();
        let plain = DOptimality { scale: DVector::repeat(2, 1.0) }.value(&c);
        assert!((plain - 6.0_f64.ln()).abs() < 1e-15);
        let scaled = DOptimality { scale: DVector::from_vec(vec![1.0, 10.0]) }.value(&c);
        assert!((plain - scaled - 100.0_f64.ln()).abs() < 1e-14);
    }
}
