//! Samples far from those beside them: a spark, a lost bit, a knock. They are no noise that averages out as `N/√τ` does.
//!
//! One outlier of size `a` among n samples looks like white noise of the variance `a²/n`, whatever the noise, and says nothing of the other samples: N with it is neither what a
//! mean of other samples does, nor what the next recording shows. So outliers are taken out, each replaced by the median about it, and said with what they would have done.

/// Samples about one, itself included, with which it is compared.
const ABOUT: usize = 5;
/// An outlier is off their median by more than so many robust standard deviations of the difference of two successive samples, which a random walk has, too: 11 of white noise.
const FAR: f64 = 8.0;
/// Where more than one sample in so many is far off, these are no outliers: the sensor moves, or its noise is like that.
const RARE: usize = 1000;
/// Median of the absolute deviations of normal noise, times this, is its standard deviation.
const MAD: f64 = 1.4826;

/// The outliers of one axis, which were left out of its noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Outliers {
    /// Which samples of the stretch, from 0.
    pub samples: Vec<usize>,
    /// Time of the one that is farthest off, s.
    pub time_s: f64,
    /// Its reading, in the unit of the readings.
    pub largest: f64,
    /// How far it is off the samples about it, in robust standard deviations of the difference of two samples.
    pub deviations: f64,
    /// `N √f_s` with the outliers, in the unit of the readings; `None` where it would not be determined.
    pub white_with_them: Option<f64>,
}

/// Outliers by the samples about them.
pub(super) struct Found {
    pub(super) samples: Vec<usize>,
    /// The one that is farthest off, and how far.
    pub(super) farthest: usize,
    pub(super) deviations: f64,
    /// The values with outliers replaced.
    pub(super) without: Vec<f64>,
}

/// Looks for outliers; `None` where there are none.
pub(super) fn find(values: &[f64]) -> Option<Found> {
    let n = values.len();
    if n < ABOUT {
        return None;
    }
    let about = |k: usize| {
        let first = k.saturating_sub(ABOUT / 2).min(n - ABOUT);
        median(&values[first..first + ABOUT])
    };
    let medians: Vec<f64> = (0..n).map(about).collect();
    let off = |k: usize| (values[k] - medians[k]).abs();
    let steps = || values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let mut sizes: Vec<f64> = steps().collect();
    let mad = *sizes.select_nth_unstable_by(n / 2, f64::total_cmp).1;
    // of readings coarser than their noise, most are like those beside them
    let finest = steps().filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min);
    let scale = (MAD * mad).max(if finest.is_finite() { finest } else { 0.0 });
    let samples: Vec<usize> = (0..n).filter(|&k| off(k) > FAR * scale).collect();
    if samples.len() > (n / RARE).max(1) {
        return None;
    }
    let farthest = *samples.iter().max_by(|&&a, &&b| off(a).total_cmp(&off(b)))?;
    let mut without = values.to_vec();
    samples.iter().for_each(|&k| without[k] = medians[k]);
    Some(Found { deviations: off(farthest) / scale, samples, farthest, without })
}

/// Median of five values, without a branch: of four, those that are neither least nor largest, and the fifth.
fn median(of: &[f64]) -> f64 {
    let &[a, b, c, d, e] = of else { return f64::NAN };
    let (low, high) = (a.min(b).max(c.min(d)), a.max(b).min(c.max(d)));
    low.min(high).max(low.max(high).min(e))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::PowerLaw;
    use crate::simulate::{Purpose, simulate_noise, stream};

    fn noise(process: PowerLaw, coefficient: f64, seed: u64) -> Vec<f64> {
        simulate_noise(process, coefficient, 0.01, 20_000, &mut stream(seed, Purpose::Sensor, 0))
    }

    #[test]
    fn the_median_of_five_is_that_of_every_order() {
        for k in 0..3125_usize {
            let values: [f64; ABOUT] = std::array::from_fn(|i| (k / 5_usize.pow(i as u32) % 5) as f64);
            let mut sorted = values;
            sorted.sort_by(f64::total_cmp);
            assert_eq!(median(&values), sorted[2], "{values:?}");
        }
    }

    #[test]
    fn neither_noise_nor_coarse_steps_have_outliers() {
        for seed in 0..20 {
            let white = noise(PowerLaw::White, 1.0, seed);
            let walk = noise(PowerLaw::RandomWalk, 30.0, seed);
            let quantised = noise(PowerLaw::Quantisation, 0.1, seed);
            let sum: Vec<f64> = white.iter().zip(&walk).map(|(one, other)| one + other).collect();
            for (what, values) in
                [("white", &white), ("walk", &walk), ("quantised", &quantised), ("sum", &sum)]
            {
                assert!(find(values).is_none(), "{what}");
                // the standard deviation of white noise is 10
                for step in [5.0, 20.0, 40.0, 80.0] {
                    let coarse: Vec<f64> = values.iter().map(|y| (y / step).round() * step).collect();
                    assert!(find(&coarse).is_none(), "{what} in steps of {step}");
                }
            }
        }
    }

    #[test]
    fn outliers_are_found_and_movements_are_none() {
        let clean = noise(PowerLaw::White, 1.0, 1);
        let mut values = clean.clone();
        for k in [0, 700, 701, 19_999] {
            values[k] += 200.0;
        }
        let found = find(&values).expect("found");
        assert_eq!(found.samples, [0, 700, 701, 19_999]);
        assert!((10.0..30.0).contains(&found.deviations), "{}", found.deviations);
        let left = found.without.iter().zip(&clean).map(|(one, other)| (one - other).abs());
        assert!(left.fold(0.0, f64::max) < 60.0);
        // a tenth of the time the sensor is shaken
        let shaken: Vec<f64> = values
            .iter()
            .enumerate()
            .map(|(k, y)| y + if k < 2000 { 500.0 * (k as f64).sin() } else { 0.0 })
            .collect();
        assert!(find(&shaken).is_none());
    }
}
