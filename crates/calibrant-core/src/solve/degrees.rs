//! The degrees of freedom that a fit leaves: `ν = n − tr(Σ F)`, with F the information of its n equations and Σ the covariance.
//!
//! Without a prior `tr(Σ F)` is the number of unknowns. A prior of weights w tells its share `Σ_kk w_k` of each unknown, and the equations the rest.

use nalgebra::DMatrix;

/// The share of each unknown's information that its prior has, 0 to 1: `Σ_kk w_k`, with the covariance `Σ` and the inverse variances `w` of the prior.
#[must_use]
pub fn shares_of_prior(weight: &[f64], covariance: &DMatrix<f64>) -> Vec<f64> {
    weight.iter().enumerate().map(|(k, weight)| (weight * covariance[(k, k)]).clamp(0.0, 1.0)).collect()
}

/// Degrees of freedom that are left to equations. `of_prior`: the shares of the prior, where there is one.
pub(crate) fn degrees_left(equations: f64, unknowns: usize, of_prior: Option<&[f64]>) -> f64 {
    match of_prior {
        None => (equations - unknowns as f64).max(0.0),
        // a prior never takes everything
        Some(shares) => (equations - (unknowns as f64 - shares.iter().sum::<f64>())).max(f64::EPSILON),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    /// Against `n − tr(Σ F)`, computed densely.
    #[test]
    fn degrees_are_the_equations_less_the_trace() {
        let rows = DMatrix::from_fn(7, 3, |i, k| (1.3 * (i * (k + 1)) as f64 + 0.4).sin());
        let of_data = rows.tr_mul(&rows);
        for weight in [[0.0, 0.0, 0.0], [2.0, 0.0, 0.7], [1e9, 1e9, 1e9]] {
            let prior = DMatrix::from_diagonal(&DVector::from_row_slice(&weight));
            let sigma = (&of_data + prior).try_inverse().expect("regular");
            let found = degrees_left(7.0, 3, Some(&shares_of_prior(&weight, &sigma)));
            let expected = 7.0 - (sigma * &of_data).trace();
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
        assert_eq!(degrees_left(7.0, 3, None), 4.0);
        assert_eq!(degrees_left(2.0, 3, None), 0.0, "no more than none are missing");
    }
}
