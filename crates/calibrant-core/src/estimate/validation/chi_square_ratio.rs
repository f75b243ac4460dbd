//! χ²/n of an honest covariance, part of which is itself an estimate.
//!
//! The scatter between holds or rotations comes from a few dozen of them. It is what is left of their variance beyond noise, so that the variance as a whole, noise included, has the
//! ν degrees of freedom; where no scatter was found, all of it is noise and known. An error predicted by a share w of such a variance has ν/w² degrees behind its prediction, and
//! χ²/n is compared with Fisher's F.
//!
//! Rates have a scatter for each axis. Their `χ²/n = Σ_i F(n/k, ν_i)/k` has the mean and the variance of `c F(n, D)` with
//!
//! ```text
//! V = variance/mean²,   D = (4 V n + 2 n − 4)/(V n − 2),   c = mean (D − 2)/D
//! ```
//!
//! which for one scatter is F itself. Of 400 000 drawn ratios of three axes, 0.54 % and 5.0 % were beyond the upper 0.5 % and 5 % points (24 holds, ν = 23), 0.55 % and 4.6 %
//! (12, ν = 8), 0.48 % and 4.2 % (24, ν = 6); one F of 3 ν degrees instead gave 1.4 % and 9 % at ν = 23. With ν ≤ 4 there is no variance: F of n and the least ν then, as if the axes had one scatter.
//!
//! Where the scatter is no larger than the noise, a few calibrations see none and predict too little: with ν = 15, n = 24 and half of the variance from the scatter, 3.1 % are beyond the upper
//! 0.5 % point. Calling only that scatter uncertain, w² of the variance, made it 7.6 %.

use crate::root::root;
use crate::solve::MANY_DEGREES;
use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor};
use std::convert::Infallible;

/// Two-sided probability that an honest covariance is doubted.
const SIGNIFICANCE: f64 = 0.01;
/// With so few degrees of freedom F has no variance.
const FEW_DEGREES: f64 = 4.0;

/// The distribution of χ²/n where the covariance is honest.
#[derive(Clone, Copy)]
pub(super) struct Ratio {
    /// n.
    components: f64,
    /// Degrees of freedom behind what was estimated.
    behind: f64,
    /// It is this times F.
    scale: f64,
}

impl Ratio {
    /// Of errors that are independent of the scatters behind their prediction. Each scatter is that of an equal share of the components; `behind`: the degrees of freedom of each, infinite
    /// where it is known.
    pub(super) fn new(components: f64, behind: &[f64]) -> Self {
        let n = components;
        let least = behind.iter().copied().fold(f64::INFINITY, f64::min);
        if least <= FEW_DEGREES || least > MANY_DEGREES {
            return Self { components: n, behind: least, scale: 1.0 };
        }
        let k = behind.len() as f64;
        let mean = behind.iter().map(|v| mean_of_f(*v)).sum::<f64>() / k;
        let variance = behind.iter().map(|v| variance_of_f(n / k, *v)).sum::<f64>() / (k * k);
        let vn = n * variance / (mean * mean);
        let d = (4.0 * vn + 2.0 * n - 4.0) / (vn - 2.0);
        Self { components: n, behind: d, scale: mean * (d - 2.0) / d }
    }

    /// Of folds: the errors of one block are part of the scatter by which the others are predicted, so that an estimate that is too small here is too large there. What
    /// is left of its uncertainty is its mean ([`mean_of_folds`]), by which errors are to be divided first.
    pub(super) fn of_folds(components: f64) -> Self {
        Self { components, behind: f64::INFINITY, scale: 1.0 }
    }

    /// The probability of a ratio at least this large.
    pub(super) fn above(self, ratio: f64) -> f64 {
        let (n, ratio) = (self.components, ratio.max(0.0) / self.scale);
        if self.behind > MANY_DEGREES {
            return ChiSquared::new(n).map_or(1.0, |distribution| distribution.sf(ratio * n));
        }
        FisherSnedecor::new(n, self.behind).map_or(1.0, |distribution| distribution.sf(ratio))
    }

    /// The ratio that is exceeded with this probability.
    pub(super) fn exceeded_with(self, probability: f64) -> f64 {
        falls_to(probability, |ratio| self.above(ratio))
    }

    /// Ratios within which so many honest covariances stay together, but for one case in a hundred (Bonferroni).
    pub(super) fn usual(self, together: usize) -> (f64, f64) {
        let level = 0.5 * SIGNIFICANCE / together as f64;
        (self.exceeded_with(1.0 - level), self.exceeded_with(level))
    }
}

/// The mean of χ²/n of folds: that of F, `ν/(ν − 2)`, over the scatters.
pub(super) fn mean_of_folds(behind: &[f64]) -> f64 {
    let k = behind.len().max(1) as f64;
    1.0 + behind.iter().map(|v| mean_of_f(*v) - 1.0).sum::<f64>() / k
}

/// `ν/(ν − 2)`, no more than 2: with fewer degrees it is the chance of very small scatters.
fn mean_of_f(v: f64) -> f64 {
    if v > MANY_DEGREES { 1.0 } else { v / (v - 2.0).max(0.5 * v) }
}

fn variance_of_f(n: f64, v: f64) -> f64 {
    if v > MANY_DEGREES {
        return 2.0 / n;
    }
    2.0 * v * v * (n + v - 2.0) / (n * (v - 2.0).powi(2) * (v - 4.0))
}

/// Where a falling function of a positive number reaches a value; 0 where it is below from the start.
pub(super) fn falls_to(value: f64, of: impl Fn(f64) -> f64) -> f64 {
    let excess = |x: f64| (x, of(x) - value);
    let (mut low, mut high) = (excess(0.0), excess(1.0));
    if low.1 <= 0.0 {
        return 0.0;
    }
    while high.1 > 0.0 && high.0 < 1e12 {
        (low, high) = (high, excess(4.0 * high.0));
    }
    if high.1 > 0.0 {
        return high.0;
    }
    let Ok(found) = root([low, high], 0.0, 0.0, |x| Ok::<f64, Infallible>(excess(x).1));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Purpose, stream};
    use rand_distr::{ChiSquared as Draw, Distribution};

    #[test]
    fn one_scatter_is_fishers_f_and_none_is_chi_square() {
        // upper 5 % points of the tables: F(10, 20) = 2.348, χ²(10) = 18.307
        assert!((Ratio::new(10.0, &[20.0]).exceeded_with(0.05) - 2.348).abs() < 5e-4);
        assert!((Ratio::new(10.0, &[f64::INFINITY]).exceeded_with(0.05) - 1.8307).abs() < 5e-5);
        assert!((Ratio::new(10.0, &[f64::INFINITY; 3]).exceeded_with(0.05) - 1.8307).abs() < 5e-5);
        assert!((mean_of_folds(&[10.0]) - 1.25).abs() < 1e-15);
        assert!((Ratio::of_folds(10.0).exceeded_with(0.05) - 1.8307).abs() < 5e-5);
    }

    /// The tails of the mean of three F, drawn.
    #[test]
    fn three_scatters_leave_the_level_where_it_is() {
        let mut rng = stream(1, Purpose::Sensor, 0);
        let count = 40_000;
        for (per_axis, behind) in [
            (24, [23.0; 3]),
            (24, [8.0, 23.0, 15.0]),
            (24, [23.0, f64::INFINITY, f64::INFINITY]),
            (1, [23.0; 3]),
        ] {
            let ratio = Ratio::new(f64::from(3 * per_axis), &behind);
            let limits = [0.05, 0.005]
                .map(|level| (level, ratio.exceeded_with(level), ratio.exceeded_with(1.0 - level)));
            let mut outside = [[0; 2]; 2];
            for _ in 0..count {
                let mut mean_square = |degrees: f64| {
                    if degrees.is_infinite() {
                        1.0
                    } else {
                        Draw::new(degrees).expect("positive").sample(&mut rng) / degrees
                    }
                };
                let drawn =
                    behind.map(|v| mean_square(f64::from(per_axis)) / mean_square(v)).iter().sum::<f64>()
                        / 3.0;
                for (outside, (_, high, low)) in outside.iter_mut().zip(limits) {
                    outside[0] += u32::from(drawn > high);
                    outside[1] += u32::from(drawn < low);
                }
            }
            for (outside, (level, ..)) in outside.iter().zip(limits) {
                let [above, below] = outside.map(|outside| f64::from(outside) / f64::from(count));
                println!("{per_axis} {behind:?}: {level} is {above} above, {below} below");
                // 4 standard deviations of a share; two moments leave the tails right to a third of the level, and the lower one may be thinner
                let room = 4.0 * (level / f64::from(count)).sqrt();
                assert!((above - level).abs() < room + level / 3.0, "{behind:?}: {above} for {level}");
                assert!(below < level + room, "{behind:?}: {below} for {level}");
            }
        }
    }

    #[test]
    fn without_a_variance_the_least_certain_scatter_counts_for_all() {
        let few = Ratio::new(72.0, &[3.0, 23.0, 23.0]).exceeded_with(0.005);
        assert!((few - Ratio::new(72.0, &[3.0]).exceeded_with(0.005)).abs() < 1e-9);
        let (below, above) = (
            Ratio::new(72.0, &[4.0; 3]).exceeded_with(0.005),
            Ratio::new(72.0, &[4.0001; 3]).exceeded_with(0.005),
        );
        assert!((below / above - 1.0).abs() < 1e-3, "{below} {above}");
    }
}
