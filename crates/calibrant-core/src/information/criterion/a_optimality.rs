//! Criterion A: the sum of the variances.

use nalgebra::{DMatrix, DVector};

/// Sum of the variances, the thesis's criterion.
///
/// `Φ_A(C) = trace C = Σ C_ii / s_i²`
///
/// Units decide: with `s = 1` a bias in m/s² is added to a scale factor without unit. On the thesis's problem
/// the bias contributes at least `σ²/M`, whatever the motion. That hides the effect of the motion on the
/// scale factor. Divide by the datasheet's spread to see it.
///
/// # Units
/// None with a scale. Without one, the sum of the squares of the parameters' units.
///
/// # References
/// `pukelsheim2006`, `vamvaka2021`
#[derive(Debug, Clone, PartialEq)]
pub struct AOptimality {
    /// The divisor of each parameter.
    pub scale: DVector<f64>,
}

impl AOptimality {
    pub(super) fn value(&self, covariance: &DMatrix<f64>) -> f64 {
        self.scale.iter().enumerate().map(|(i, s)| covariance[(i, i)] / (s * s)).sum()
    }

    pub(super) fn derivative(&self) -> DMatrix<f64> {
        DMatrix::from_diagonal(&self.scale.map(|s| 1.0 / (s * s)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_is_the_sum_of_scaled_variances() {
        let c = super::super::by_hand();
        assert_eq!(AOptimality { scale: DVector::from_vec(vec![1.0, 1.0]) }.value(&c), 7.0);
        assert_eq!(AOptimality { scale: DVector::from_vec(vec![1.0, 2.0]) }.value(&c), 5.5);
    }
}
