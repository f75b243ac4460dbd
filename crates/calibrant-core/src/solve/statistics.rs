//! How probable a χ² is: that of residuals whose variance is known, and that of residuals whose variance is estimated.

use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};

/// From this number of degrees of freedom on, F is taken for χ² over its degrees.
pub(crate) const MANY_DEGREES: f64 = 1e5;

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
