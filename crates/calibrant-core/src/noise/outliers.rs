//! Outliers of a sensor at rest: samples far from those beside them, such as a spike, a lost bit, a knock.
//! They do not average out as `N/√τ` does.
//!
//! One outlier of size `a` among n samples looks like white noise of the variance `a²/n`, whatever the noise
//! is. It shows nothing about the other samples. With it, N predicts neither a mean of other samples nor the
//! next recording. So each outlier is replaced by a sample like those about it, and its effect on N is
//! reported.
//!
//! # What an outlier is
//! - *Far off*: from the median of the nine samples about it. At an end of the recording, all nine are on one
//!   side, and smooth noise is far from their median. There it is also far from lines through the next three
//!   samples. With a share `p` of outliers anywhere, five of nine are outliers with the probability `126 p⁵`,
//!   which is 4·10⁻⁷ at 2 %. Up to that share the median is not an outlier.
//! - *Isolated*: most of these nine are not far off. A sensor that is shaken is far off throughout. The
//!   median follows a sensor that moves slowly.
//! - *Of another kind than the noise*: noise of finite variance has a density that falls faster than `x⁻³`.
//!   So at most a quarter of the samples beyond half a distance are beyond the distance. Outliers are fewer
//!   between half the distance and the distance than beyond it.
//!
//! # The replacement
//! The replacement is another sample, as far away as the noise is still white. It varies as the lost one did,
//! and N neither gains nor loses. A median would vary less, and repeat its neighbours' errors. Where the
//! readings wander or are filtered, no sample far away is like it, and the median is used.

use super::steps::{Steps, typical_step};

/// Number of samples, the examined one included, whose median is compared with it.
const WINDOW_SAMPLES: usize = 9;
/// Threshold for an outlier in robust standard deviations of the difference of two successive samples. It is
/// 11 of white noise; a random walk has such differences, too.
const OUTLIER_DEVIATIONS: f64 = 8.0;
/// For noise of finite variance: ratio of samples between half that distance and the distance to samples
/// beyond it.
const HEAVY_TAIL: usize = 3;
/// Where more than one sample in this number is an outlier, none is removed.
const MOST_OUTLIERS_ONE_IN: usize = 50;
/// The sensor moves where more than one sample is far off without isolation for this number of isolated ones.
const MOVING: usize = 10;
/// Largest distance, in samples, of the sample that replaces an outlier.
const LARGEST_DISTANCE: usize = 64;
/// At that distance, samples differ by at most this factor more than successive ones.
const WHITE_FACTOR: f64 = 1.1;

/// The outliers of one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Outliers {
    /// Which samples of the segment, from 0.
    pub samples: Vec<usize>,
    /// Time of the farthest outlier, s.
    pub time_s: f64,
    /// Its reading, in the unit of the readings.
    pub largest: f64,
    /// Its distance from the samples about it, in robust standard deviations of the difference of two
    /// samples.
    pub deviations: f64,
    /// Were they removed from the noise? Not where they are more than one in fifty samples.
    pub left_out: bool,
    /// `N √f_s` with the outliers, in the unit of the readings; `None` where it would not be determined.
    pub white_with_them: Option<f64>,
}

/// Outliers, found from the samples about them.
pub(super) struct Found {
    pub(super) samples: Vec<usize>,
    /// The outlier that is farthest off.
    pub(super) farthest: usize,
    pub(super) deviations: f64,
    /// The values with outliers replaced; `None` where there are too many.
    pub(super) without: Option<Vec<f64>>,
}

/// Looks for outliers. `None` where there are none, where the sensor moves, and where its noise has such
/// tails.
pub(super) fn find(values: &[f64], steps: &Steps) -> Option<Found> {
    let found = OutlierCandidates::of(values, steps)?;
    let isolated = found.isolated();
    let farthest = isolated.iter().max_by(|one, other| one.off.total_cmp(&other.off))?;
    let samples: Vec<usize> = isolated.iter().map(|sample| sample.k).collect();
    let restless = found.samples.len() - samples.len();
    if restless * MOVING > samples.len() || found.half_as_far >= HEAVY_TAIL * samples.len() {
        return None;
    }
    let few = samples.len() <= (values.len() / MOST_OUTLIERS_ONE_IN).max(1);
    Some(Found {
        farthest: farthest.k,
        deviations: farthest.off / found.scale,
        without: few.then(|| replaced(values, steps, &found, &isolated)),
        samples,
    })
}

/// The values that are far off.
struct OutlierCandidates {
    /// Robust standard deviation of the difference of two successive values.
    scale: f64,
    /// The values that are far off, in order.
    samples: Vec<Sample>,
    /// Number of values that are off by less, but by more than half of that.
    half_as_far: usize,
}

/// A value that is far off.
#[derive(Clone, Copy)]
struct Sample {
    k: usize,
    /// The median about it, and its distance from the median.
    median: f64,
    off: f64,
}

impl OutlierCandidates {
    /// `None` for a few values, and where nothing is off by half as much.
    fn of(values: &[f64], steps: &Steps) -> Option<Self> {
        let n = values.len();
        if n < WINDOW_SAMPLES {
            return None;
        }
        // readings coarser than their noise mostly equal their neighbours
        let scale = steps.typical.max(if steps.finest.is_finite() { steps.finest } else { 0.0 });
        let far = OUTLIER_DEVIATIONS * scale;
        let mut found = Self { scale, samples: Vec::new(), half_as_far: 0 };
        for k in (0..n).filter(|&k| may_be_off(values, k, far / 2.0)) {
            let median = median_about(values, k);
            let off = (values[k] - median).abs().min(off_line_at_end(values, k));
            if off > far {
                found.samples.push(Sample { k, median, off });
            } else if off > far / 2.0 {
                found.half_as_far += 1;
            }
        }
        (!found.samples.is_empty()).then_some(found)
    }

    /// The values that are far off while most of their neighbours are not.
    fn isolated(&self) -> Vec<Sample> {
        let within = |k: usize| {
            let from = self.samples.partition_point(|other| other.k + WINDOW_SAMPLES / 2 < k);
            self.samples[from..].iter().take_while(|other| other.k <= k + WINDOW_SAMPLES / 2).count()
        };
        self.samples.iter().filter(|sample| within(sample.k) <= WINDOW_SAMPLES / 2).copied().collect()
    }
}

/// A quick bound. A value this far from the median of the nine about it is also this far from one of the four
/// nearest. Five of the eight others are as far as the median.
fn may_be_off(values: &[f64], k: usize, by: f64) -> bool {
    if k < WINDOW_SAMPLES / 2 || k + WINDOW_SAMPLES / 2 >= values.len() {
        return true;
    }
    let off = |other: usize| (values[other] - values[k]).abs() > by;
    off(k - 1) || off(k + 1) || off(k - 2) || off(k + 2)
}

fn median_about(values: &[f64], k: usize) -> f64 {
    let first = k.saturating_sub(WINDOW_SAMPLES / 2).min(values.len() - WINDOW_SAMPLES);
    let mut about = [0.0; WINDOW_SAMPLES];
    about.copy_from_slice(&values[first..first + WINDOW_SAMPLES]);
    *about.select_nth_unstable_by(WINDOW_SAMPLES / 2, f64::total_cmp).1
}

/// Near an end, the distance of a value from the nearest line through two of the three values next to it. One
/// of these three may be an outlier.
fn off_line_at_end(values: &[f64], k: usize) -> f64 {
    let next: fn(usize, usize) -> usize = match k {
        _ if k < WINDOW_SAMPLES / 2 => |k, by| k + by,
        _ if k + WINDOW_SAMPLES / 2 >= values.len() => |k, by| k - by,
        _ => return f64::INFINITY,
    };
    let off = |(near, far): (usize, usize)| {
        let (one, other) = (values[next(k, near)], values[next(k, far)]);
        (values[k] - one - (one - other) * near as f64 / (far - near) as f64).abs()
    };
    [(1, 2), (1, 3), (2, 3)].map(off).into_iter().fold(f64::INFINITY, f64::min)
}

/// The values with replacements at these places.
fn replaced(values: &[f64], steps: &Steps, found: &OutlierCandidates, isolated: &[Sample]) -> Vec<f64> {
    let n = values.len();
    let is_white =
        n > 2 * LARGEST_DISTANCE && typical_step(values, LARGEST_DISTANCE) <= WHITE_FACTOR * steps.typical;
    let is_good = |k: &usize| *k < n && found.samples.binary_search_by_key(k, |sample| sample.k).is_err();
    let mut without = values.to_vec();
    for sample in isolated {
        let away =
            [sample.k + LARGEST_DISTANCE, sample.k.wrapping_sub(LARGEST_DISTANCE)].into_iter().find(is_good);
        without[sample.k] = away.filter(|_| is_white).map_or(sample.median, |k| values[k]);
    }
    without
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::PowerLaw;
    use crate::simulate::{Purpose, simulate_noise, stream};

    fn find(values: &[f64]) -> Option<Found> {
        super::find(values, &Steps::of(values))
    }

    fn noise(process: PowerLaw, coefficient: f64, seed: u64) -> Vec<f64> {
        simulate_noise(process, coefficient, 0.01, 20_000, &mut stream(seed, Purpose::Sensor, 0))
    }

    /// The filter that saves most medians passes every value that it must.
    #[test]
    fn every_value_that_is_far_off_is_looked_at() {
        let mut values = noise(PowerLaw::White, 1.0, 3);
        values.iter_mut().enumerate().for_each(|(k, y)| *y += 60.0 * (0.7 * k as f64).sin());
        for by in [5.0, 20.0, 60.0] {
            for k in 0..values.len() {
                let off = (values[k] - median_about(&values, k)).abs();
                assert!(off <= by || may_be_off(&values, k, by), "{k}: {off}");
            }
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

    /// Where noise is smooth, the first sample is four steps off the median of the nine next to it.
    #[test]
    fn the_ends_of_smooth_noise_are_no_outliers() {
        let mean = |values: Vec<f64>| -> Vec<f64> {
            values.windows(25).map(|window| window.iter().sum::<f64>() / 25.0).collect()
        };
        for seed in 0..400 {
            let white =
                simulate_noise(PowerLaw::White, 1.0, 0.01, 2000, &mut stream(seed, Purpose::Sensor, 0));
            let smooth = mean(mean(white));
            assert!(find(&smooth).is_none(), "{seed}");
            let last = smooth.len() - 1;
            for k in [0, 1, 3, last - 2, last] {
                let mut values = smooth.clone();
                values[k] += 20.0;
                assert_eq!(find(&values).expect("a spark").samples, [k], "{seed}");
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
        let without = found.without.expect("few");
        let left = without.iter().zip(&clean).map(|(one, other)| (one - other).abs());
        assert!(left.fold(0.0, f64::max) < 80.0);
        // the sensor is shaken for a tenth of the time
        let shaken: Vec<f64> = values
            .iter()
            .enumerate()
            .map(|(k, y)| y + if k < 2000 { 500.0 * (k as f64).sin() } else { 0.0 })
            .collect();
        assert!(find(&shaken).is_none());
    }
}
