//! Tests on the residuals.

use super::Whiteness;
use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};

/// So many degrees of freedom are as good as infinitely many.
const MANY_DEGREES: f64 = 1e5;

/// Probability of a χ² at least this large. `None` without degrees of freedom.
#[must_use]
pub fn chi2_p_value(chi2: f64, degrees_of_freedom: usize) -> Option<f64> {
    if degrees_of_freedom == 0 {
        return None;
    }
    ChiSquared::new(degrees_of_freedom as f64).ok().map(|distribution| distribution.sf(chi2.max(0.0)))
}

/// Probability of a χ² of n components at least this large, where a variance with `behind` degrees of freedom scales it: Fisher's F of χ²/n.
/// With infinitely many it is χ². With one component, it is the two-sided Student's t of its root. `None` without components.
#[must_use]
pub fn f_p_value(chi2: f64, components: usize, behind: f64) -> Option<f64> {
    if behind > MANY_DEGREES || components == 0 {
        return chi2_p_value(chi2, components);
    }
    let n = components as f64;
    FisherSnedecor::new(n, behind).ok().map(|distribution| distribution.sf(chi2.max(0.0) / n))
}

/// The χ² of n components that is exceeded with this probability.
pub(crate) fn chi2_of_p_value(p_value: f64, components: usize) -> f64 {
    ChiSquared::new(components as f64).map_or(0.0, |distribution| distribution.inverse_cdf(1.0 - p_value))
}

/// Ljung–Box test of the residuals of a fit (`ljung1978`).
///
/// `Q = Σ_{l=1..L} (T_l/σ̂² + c_l)²/(n − l − q)`, `T_l = Σ_k r_k r_{k+l}`, is close to χ² with L degrees of freedom for white noise. The
/// covariance of residuals is `σ² (I − P)`. The fit takes `c_l = Σ_k P_{k,k+l}` (`shortfall`, lag 1 first) from the l-th autocovariance. `q = tr P`
/// (`leverage`) is the effective number of unknowns, and `σ̂² = Σ r²/(n − q)`. Without these two corrections, the test rejects a third of all white
/// recordings with ten samples for each motion node.
///
/// `None` with fewer than ten degrees of freedom, or zero residuals.
pub(crate) fn ljung_box(residuals: &[f64], shortfall: &[f64], leverage: f64) -> Option<Whiteness> {
    let n = residuals.len() as f64;
    let squares = dot(residuals, residuals);
    let lags = shortfall.len().min(((n - leverage) / 5.0).max(0.0) as usize);
    if n - leverage < 10.0 || squares.is_nan() || squares <= 0.0 {
        return None;
    }
    let variance = squares / (n - leverage);
    let statistic = (1..=lags)
        .zip(shortfall)
        .map(|(lag, shortfall)| {
            let product = dot(&residuals[..residuals.len() - lag], &residuals[lag..]);
            (product / variance + shortfall).powi(2) / (n - lag as f64 - leverage)
        })
        .sum::<f64>();
    let p_value = chi2_p_value(statistic, lags)?;
    Some(Whiteness { statistic, lags, p_value })
}

/// Scalar product, in four running sums for vector instructions.
pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    let (xs, ys) = (x.chunks_exact(4), y.chunks_exact(4));
    let rest: f64 = xs.remainder().iter().zip(ys.remainder()).map(|(x, y)| x * y).sum();
    let mut sums = [0.0; 4];
    for (x, y) in xs.zip(ys) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    sums.iter().sum::<f64>() + rest
}
