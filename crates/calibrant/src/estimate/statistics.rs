//! Tests on the residuals.

use super::Whiteness;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Probability of a χ² at least this large with so many degrees of freedom; `None` without degrees of freedom.
pub(crate) fn chi2_p_value(chi2: f64, degrees_of_freedom: usize) -> Option<f64> {
    if degrees_of_freedom == 0 {
        return None;
    }
    ChiSquared::new(degrees_of_freedom as f64).ok().map(|distribution| distribution.sf(chi2.max(0.0)))
}

/// Ljung–Box test: `Q = n (n + 2) Σ_{l=1..L} ρ_l²/(n − l)` is χ² with L degrees of freedom for white residuals, `L = min(20, n/5)`.
///
/// `None` for fewer than ten residuals or residuals that vanish.
pub(crate) fn ljung_box(residuals: impl Iterator<Item = f64> + Clone) -> Option<Whiteness> {
    let n = residuals.clone().count();
    let lags = (n / 5).min(20);
    let squares: f64 = residuals.clone().map(|r| r * r).sum();
    if n < 10 || squares <= 0.0 || !squares.is_finite() {
        return None;
    }
    let statistic = n as f64
        * (n as f64 + 2.0)
        * (1..=lags)
            .map(|lag| {
                let product: f64 =
                    residuals.clone().zip(residuals.clone().skip(lag)).map(|(r, s)| r * s).sum();
                (product / squares).powi(2) / (n - lag) as f64
            })
            .sum::<f64>();
    let p_value = chi2_p_value(statistic, lags)?;
    Some(Whiteness { statistic, lags, p_value })
}
