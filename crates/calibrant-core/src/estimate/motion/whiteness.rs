//! Are the residuals of a fit white?

use crate::estimate::Whiteness;
use crate::solve::chi2_p_value;

/// Ljung–Box test of the residuals of a fit (`ljung1978`).
///
/// `Q = Σ_{l=1..L} (T_l/σ̂² + c_l)²/(n − l − q)`, `T_l = Σ_k r_k r_{k+l}`, is close to χ² with L degrees of freedom for white noise. The
/// covariance of residuals is `σ² (I − P)`. The fit takes `c_l = Σ_k P_{k,k+l}` (`shortfall`, lag 1 first) from the l-th autocovariance. `q = tr P`
/// (`leverage`) is the effective number of unknowns, and `σ̂² = Σ r²/(n − q)`. Without these two corrections, the test rejects a third of all white
/// recordings with ten samples for each motion node.
///
/// `None` with fewer than ten degrees of freedom, or zero residuals.
pub(super) fn ljung_box(residuals: &[f64], shortfall: &[f64], leverage: f64) -> Option<Whiteness> {
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
pub(super) fn dot(x: &[f64], y: &[f64]) -> f64 {
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
