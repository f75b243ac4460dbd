//! Confidence bounds of a variance, from the distribution of its estimate: a test, inverted at [`CONFIDENCE`].

use crate::root::root;
use statrs::distribution::{ContinuousCDF, Gamma};
use std::convert::Infallible;

/// The bounds are values of a variance `θ`. Under each, an estimate at least as high, or at least as low, as
/// `estimate` has half the probability outside the interval. `variance(θ)` is the variance of the estimate if
/// `θ` is true.
///
/// With `variance(θ) = 2 θ²/ν` these are the bounds `ν θ̂/χ²` of the χ² distribution with ν degrees of freedom.
pub(super) fn bounds(estimate: f64, variance: impl Fn(f64) -> f64) -> (f64, f64) {
    let tail = 0.5 * (1.0 - CONFIDENCE);
    let low = crossing(estimate, &variance, 1.0 - tail, 1e-6, 1.0);
    (low, upper(estimate, &variance, tail))
}

/// The value of `θ` above which an estimate as low as this one has less than this probability.
pub(super) fn upper(estimate: f64, variance: &impl Fn(f64) -> f64, tail: f64) -> f64 {
    crossing(estimate, variance, tail, 1.0, 1e6)
}

/// The place in `estimate · (from … to)` where the probability of a lower estimate falls through `p`; the end
/// where it does not.
fn crossing(estimate: f64, variance: &impl Fn(f64) -> f64, p: f64, from: f64, to: f64) -> f64 {
    let excess = |theta: f64| lower_probability(estimate, theta, variance(theta)) - p;
    let (first, last) = (excess(estimate * from), excess(estimate * to));
    if first < 0.0 {
        return 0.0;
    }
    if last > 0.0 {
        return f64::INFINITY;
    }
    let (from, to) = (from.ln(), to.ln());
    // on the logarithm: the range spans many decades
    let Ok(logarithm) = root([(from, first), (to, last)], 0.0, 1e-9, |logarithm| {
        Ok::<f64, Infallible>(excess(estimate * logarithm.exp()))
    });
    estimate * logarithm.exp()
}

/// Probability of an estimate below this one. The estimate follows a gamma distribution of this mean and
/// variance.
fn lower_probability(estimate: f64, mean: f64, variance: f64) -> f64 {
    Gamma::new(mean * mean / variance, mean / variance).map_or(f64::NAN, |gamma| gamma.cdf(estimate))
}

/// Probability that a stated interval covers the truth.
pub const CONFIDENCE: f64 = 0.95;

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::distribution::ChiSquared;

    #[test]
    fn of_a_chi_square_variance_they_are_those_of_the_textbook() {
        for nu in [2.5, 10.0, 1000.0] {
            let chi2 = ChiSquared::new(nu).expect("valid");
            let (low, high) = bounds(3.0, |theta| 2.0 * theta * theta / nu);
            assert!((low / (3.0 * nu / chi2.inverse_cdf(0.975)) - 1.0).abs() < 1e-4, "{nu}: {low}");
            assert!((high / (3.0 * nu / chi2.inverse_cdf(0.025)) - 1.0).abs() < 1e-4, "{nu}: {high}");
        }
    }
}
