//! Criterion c: a weighted sum of variances.

use nalgebra::{DMatrix, DVector};

/// Weighted sum of the variances, with weights of the user's choice.
///
/// `Φ_c(C) = Σ w_i C_ii`
///
/// Weight 1 on one parameter and 0 on the others asks for the motion that determines this parameter best.
///
/// # Units
/// The unit of the weights times the squares of the parameters' units.
///
/// # References
/// `pukelsheim2006`
#[derive(Debug, Clone, PartialEq)]
pub struct COptimality {
    /// The weights `w_i ≥ 0`, one for each parameter, at least one of them positive.
    pub weights: DVector<f64>,
}

impl COptimality {
    pub(super) fn value(&self, covariance: &DMatrix<f64>) -> f64 {
        self.weights.iter().enumerate().map(|(i, w)| w * covariance[(i, i)]).sum()
    }

    pub(super) fn derivative(&self) -> DMatrix<f64> {
        DMatrix::from_diagonal(&self.weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn c_weighs_variances() {
        let c = super::super::by_hand();
        assert_eq!(COptimality { weights: DVector::from_vec(vec![0.0, 3.0]) }.value(&c), 6.0);
    }
}
