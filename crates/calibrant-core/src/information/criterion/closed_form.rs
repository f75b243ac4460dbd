//! The criteria in closed form: A, c, D, E and M, as functions of the covariance divided by its scales.

use nalgebra::{Cholesky, DMatrix, DVector};

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

/// `C_ij / (s_i s_j)`.
pub(super) fn scaled(covariance: &DMatrix<f64>, scale: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(scale.len(), scale.len(), |i, j| covariance[(i, j)] / (scale[i] * scale[j]))
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

    #[test]
    fn c_weighs_variances() {
        let c = super::super::by_hand();
        assert_eq!(COptimality { weights: DVector::from_vec(vec![0.0, 3.0]) }.value(&c), 6.0);
    }

    #[test]
    fn d_is_the_log_determinant_and_units_add_a_constant() {
        let c = super::super::by_hand();
        let plain = DOptimality { scale: DVector::repeat(2, 1.0) }.value(&c);
        assert!((plain - 6.0_f64.ln()).abs() < 1e-15);
        let scaled = DOptimality { scale: DVector::from_vec(vec![1.0, 10.0]) }.value(&c);
        assert!((plain - scaled - 100.0_f64.ln()).abs() < 1e-14);
    }

    #[test]
    fn e_is_the_largest_eigenvalue() {
        let c = super::super::by_hand();
        assert!((EOptimality { scale: DVector::repeat(2, 1.0) }.value(&c) - 6.0).abs() < 1e-14);
    }

    #[test]
    fn m_is_the_largest_variance() {
        let c = super::super::by_hand();
        assert_eq!(MOptimality { scale: DVector::repeat(2, 1.0) }.value(&c), 5.0);
        assert_eq!(MOptimality { scale: DVector::from_vec(vec![5.0, 1.0]) }.value(&c), 2.0);
    }
}
