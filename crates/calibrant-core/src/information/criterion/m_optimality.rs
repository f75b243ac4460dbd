//! Criterion M: the variance of the worst parameter.

use nalgebra::{DMatrix, DVector};

/// Largest variance of a single parameter.
///
/// `Φ_M(C) = max_i C_ii / s_i²`
///
/// Not smooth where two variances are equal, as optimal designs make them.
///
/// # Units
/// None with a scale. Mixed without one, so a scale is advisable.
///
/// # References
/// `pukelsheim2006`
#[derive(Debug, Clone, PartialEq)]
pub struct MOptimality {
    /// The divisor of each parameter.
    pub scale: DVector<f64>,
}

impl MOptimality {
    fn variances(&self, covariance: &DMatrix<f64>) -> DVector<f64> {
        DVector::from_fn(self.scale.len(), |i, _| covariance[(i, i)] / (self.scale[i] * self.scale[i]))
    }

    pub(super) fn value(&self, covariance: &DMatrix<f64>) -> f64 {
        self.variances(covariance).max()
    }

    pub(super) fn derivative(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        let worst = self.variances(covariance).imax();
        let mut derivative = DMatrix::zeros(self.scale.len(), self.scale.len());
        derivative[(worst, worst)] = self.scale[worst].powi(-2);
        derivative
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn m_is_the_largest_variance() {
        let c = super::super::by_hand();
        assert_eq!(MOptimality { scale: DVector::repeat(2, 1.0) }.value(&c), 5.0);
        assert_eq!(MOptimality { scale: DVector::from_vec(vec![5.0, 1.0]) }.value(&c), 2.0);
    }
}
