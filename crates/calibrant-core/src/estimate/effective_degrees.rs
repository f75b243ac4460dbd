//! Degrees of freedom behind a sum of variances that are estimates themselves (Welch and Satterthwaite, `gum`, `satterthwaite1946`).
//!
//! Shares `w` of a variance with ν degrees of freedom have `1/Σ (w²/(ν + 2)) − 2` together. This is the formula for estimated shares: `E s⁴ = σ⁴ (1 + 2/ν)`, so `s⁴/(ν + 2)`
//! estimates `σ⁴/ν` without bias.

/// Degrees of freedom behind a sum of variances: of pairs of a variance and its degrees.
#[must_use]
pub fn degrees_of_sum(variances: &[(f64, f64)]) -> f64 {
    let shares = probable_shares(variances);
    of_shares(shares.into_iter().zip(variances).map(|(share, (_, degrees))| (share, *degrees)))
}

/// Degrees of freedom behind a sum, of the shares of its variances and the degrees of each.
pub(super) fn of_shares(shares: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let parts = shares.into_iter().map(|(share, degrees)| share * share / (degrees + 2.0));
    1.0 / parts.sum::<f64>() - 2.0
}

/// The share of each variance in the sum. A variance of few residuals is probably larger than it is estimated, by the mean of the inverse χ²: ν/(ν − 2), limited for few.
pub(super) fn probable_shares(variances: &[(f64, f64)]) -> Vec<f64> {
    let probable = |&(variance, degrees): &(f64, f64)| {
        let factor = if degrees.is_finite() { degrees / (degrees - 2.0).max(0.25 * degrees) } else { 1.0 };
        variance * factor
    };
    let probable: Vec<f64> = variances.iter().map(probable).collect();
    let sum: f64 = probable.iter().sum();
    probable.into_iter().map(|variance| variance / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_variances_have_the_sum_of_their_degrees_and_one_alone_has_its_own() {
        assert!((degrees_of_sum(&[(0.7, 5.0)]) - 5.0).abs() < 1e-12);
        // 2 (ν + 2) − 2: the formula is that for estimated shares
        assert!((degrees_of_sum(&[(0.1, 6.0), (0.1, 6.0)]) - 14.0).abs() < 1e-12);
        assert!((degrees_of_sum(&[(1.0, 5.0), (0.0, 50.0)]) - 5.0).abs() < 1e-12);
        assert_eq!(degrees_of_sum(&[(1.0, f64::INFINITY), (3.0, f64::INFINITY)]), f64::INFINITY);
    }
}
