//! Residuals in the standard deviations that are expected of them, their own influence removed.
//!
//! A residual of variance V with derivative J by the parameters has the variance `V − J Σ Jᵀ` where it was fitted, and `V + J Σ Jᵀ` where it was left out.

use nalgebra::{Matrix2, Vector2};

/// A residual that keeps less than this share of its variance decides the parameters by itself.
const LEAST_SHARE: f64 = 1e-6;
/// χ² per degree of freedom, at least: residuals far below their noise are what terms left that were fitted before.
const LEAST_SCATTER: f64 = 0.1;

/// χ² of a fit and the degrees of freedom behind it.
#[derive(Clone, Copy)]
pub(crate) struct Scatter {
    pub(crate) chi2: f64,
    pub(crate) degrees_of_freedom: f64,
}

/// Of a number. `own`: V; `from_parameters`: J Σ Jᵀ. The scatter of those that are used is estimated without this one (external).
pub(crate) fn studentised(
    residual: f64,
    (own, from_parameters): (f64, f64),
    is_used: bool,
    Scatter { chi2, degrees_of_freedom: degrees }: Scatter,
) -> f64 {
    if !is_used {
        return residual / (own + from_parameters).sqrt();
    }
    let scatter = if degrees > 0.0 { (chi2 / degrees).max(LEAST_SCATTER) } else { 1.0 };
    let left = (own - from_parameters).max(LEAST_SHARE * own);
    let internal = residual / left.sqrt() / scatter.sqrt();
    if degrees < 2.0 {
        return internal;
    }
    internal * ((degrees - 1.0) / (degrees - internal * internal).max(1e-3 * degrees)).sqrt()
}

/// The length of two numbers, whose square is χ² of two degrees of freedom. Zero where they decide the parameters by themselves.
pub(crate) fn studentised_length(
    residual: &Vector2<f64>,
    (own, from_parameters): (&Matrix2<f64>, &Matrix2<f64>),
    is_used: bool,
) -> f64 {
    let expected = if is_used { own - from_parameters } else { own + from_parameters };
    let inverse = expected.try_inverse().filter(|_| expected.determinant() > LEAST_SHARE * own.determinant());
    inverse.map_or(0.0, |inverse| residual.dot(&(inverse * residual)).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    const READINGS: [f64; 5] = [0.3, -1.2, 0.4, 2.5, -0.6];

    /// A mean of equal variances: the residual of one without it in the fit, over the scatter of the others, is Student's t by the textbook.
    #[test]
    fn a_deletion_residual_is_that_of_a_fit_without_it() {
        let mean = READINGS.iter().sum::<f64>() / 5.0;
        let chi2 = READINGS.iter().map(|y| (y - mean).powi(2)).sum::<f64>();
        for (k, y) in READINGS.iter().enumerate() {
            let others: Vec<f64> = (0..5).filter(|j| *j != k).map(|j| READINGS[j]).collect();
            let without = others.iter().sum::<f64>() / 4.0;
            let variance = others.iter().map(|y| (y - without).powi(2)).sum::<f64>() / 3.0;
            let expected = (y - without) / (variance * (1.0 + 0.25)).sqrt();
            let scatter = Scatter { chi2, degrees_of_freedom: 4.0 };
            let found = studentised(y - mean, (1.0, 0.2), true, scatter);
            assert!((found - expected).abs() < 1e-12, "{k}: {found} {expected}");
            // with a known variance, the one that was left out
            let found = studentised(y - without, (1.0, 0.25), false, scatter);
            assert!((found - (y - without) / 1.25_f64.sqrt()).abs() < 1e-12, "{k}: {found}");
            // two components of which the second is always zero
            let (own, from) = (Matrix2::identity(), Matrix2::from_diagonal(&Vector2::new(0.25, 0.25)));
            let length = studentised_length(&Vector2::new(y - without, 0.0), (&own, &from), false);
            assert!((length - found.abs()).abs() < 1e-12, "{k}: {length}");
        }
    }

    #[test]
    fn a_residual_that_decides_by_itself_is_not_told_by_rounding() {
        let scatter = Scatter { chi2: 1.0, degrees_of_freedom: 1.0 };
        assert!(studentised(1e-9, (1.0, 1.0 + 1e-15), true, scatter).abs() < 1e-5);
        let one = Matrix2::identity();
        assert_eq!(studentised_length(&Vector2::repeat(1e-9), (&one, &(one * (1.0 - 1e-12))), true), 0.0);
    }
}
