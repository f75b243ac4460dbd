//! A vibration or a hum: a line in the spectrum, which no sum of the processes has. In the Allan deviation it looks like noise at some cluster times and like a filter at others.
//!
//! A line is a peak of the periodogram over the median about it. Ordinates of noise are exponential: one in `e^x` is `x` times their mean, which is the median over `ln 2`. What the bins
//! about it have beyond that mean is its variance `p`, half the square of the amplitude of a sine; a frequency that wanders has it in several. It adds
//!
//! ```text
//! 2 p sin⁴(π f m)/(m² sin²(π f))
//! ```
//!
//! to the Allan variance of clusters of `m` samples, at the frequency `f` in cycles per sample, and that is taken off before the fit. Leakage of a sine and a phase that walks at random both have tails
//! that fall like `1/k²` in the distance of `k` bins: what is beyond `2k` bins is what is between `k` and `2k`, and is taken off with the rest.
//!
//! # Where the noise is in doubt
//! Where lines are most of the Allan variance at a cluster time that is fitted, and where their tails, known to no more than their size, are more than the standard deviation of N².

use super::regression::Regression;
use nalgebra::DVector;
use std::f64::consts::{LN_2, PI};

/// Logarithm of the inverse probability of such a peak by chance, over all frequencies.
const BEYOND_CHANCE: f64 = 14.0;
/// A peak is the highest of so many bins on each side.
const ABOUT: usize = 32;
/// Its noise is the median of up to so many, and no more than half of its own number: closer to zero slow noise is too steep.
const WIDELY: usize = 256;
/// Bins on each side that are a line's,
const LINE: usize = 16;
/// of which those beyond so many are its tail.
const TAIL: usize = 8;
/// Lines are most of a fitted Allan variance from this part on.
const MOST: f64 = 0.5;
/// From this part of an Allan variance on, fitted or not, too little is left to be known.
const ALL: f64 = 0.97;
/// Lines are worth a word if they have this part of the variance of the samples.
const SHARE: f64 = 0.01;

/// Lines in the spectrum of an axis that are worth a word.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    /// Frequency of the strongest, Hz.
    pub frequency_hz: f64,
    /// Part of the variance of the samples that all have.
    pub share: f64,
    /// Part of N² that they would add, were they left in.
    pub of_white: f64,
    /// Can they be taken off so well that the noise is not in doubt?
    pub left_out: bool,
}

/// What the lines in the spectrum of some values add to their Allan variances.
pub(super) struct Lines {
    /// Frequency, in cycles per sample, of the strongest.
    frequency: f64,
    /// Part of the variance of the values.
    share: f64,
    /// At each scale.
    adds: DVector<f64>,
    /// What of that is beyond the bins of the lines.
    tails: DVector<f64>,
}

impl Lines {
    /// Those that are beyond chance; `None` without any.
    pub(super) fn of(values: &[f64], scales: &[usize]) -> Option<Self> {
        if values.len() < 8 * ABOUT {
            return None;
        }
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let square: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let size = values.len().next_power_of_two();
        let powers = periodogram(values.iter().map(|value| value - mean), size);
        let last = powers.len() - 1;
        let near = |k: usize, by: usize| k - by..=(k + by).min(last);
        let beyond = (size as f64).ln() + BEYOND_CHANCE;
        // a bin's part of the variance of the values
        let unit = 2.0 / (size as f64 * square);
        let (mut bins, mut tails, mut strongest) = (Vec::new(), Vec::new(), (0.0, 0.0));
        for k in 2 * ABOUT..=last {
            if powers[near(k, ABOUT)].iter().any(|other| *other > powers[k]) {
                continue;
            }
            let about = || {
                let others = near(k, WIDELY.min(k / 2)).filter(|other| other.abs_diff(k) > LINE);
                others.map(|other| powers[other])
            };
            let middle = about().count() / 2;
            // most peaks are noise: so many are above the median that a line would need, which is cheaper to see than the median
            let least = powers[k] / beyond * LN_2;
            if about().filter(|power| *power <= least).count() <= middle {
                continue;
            }
            let mut about: Vec<f64> = about().collect();
            let noise = *about.select_nth_unstable_by(middle, f64::total_cmp).1 / LN_2;
            if noise <= 0.0 || powers[k] < beyond * noise {
                continue;
            }
            let frequency = |j: usize| j as f64 / size as f64;
            let of_line = |j: usize| (frequency(j), unit * (powers[j] - noise));
            bins.extend(near(k, LINE).map(of_line));
            tails.extend(near(k, LINE).filter(|j| j.abs_diff(k) > TAIL).map(of_line));
            if powers[k] > strongest.1 {
                strongest = (frequency(k), powers[k]);
            }
        }
        if bins.is_empty() {
            return None;
        }
        let share = bins.iter().chain(&tails).map(|bin| bin.1).sum();
        let at_scales = |bins: &[(f64, f64)]| {
            let sum = |&m: &usize| square / count * allan_variance(bins, m as f64);
            DVector::from_iterator(scales.len(), scales.iter().map(sum))
        };
        let tails = at_scales(&tails);
        let adds = (at_scales(&bins) + &tails).map(|adds| adds.max(0.0));
        Some(Self { frequency: strongest.0, share, adds, tails })
    }

    /// The Allan variances without them; as they are where next to nothing would be left.
    pub(super) fn taken_off(&self, observed: &DVector<f64>) -> DVector<f64> {
        if self.most_of(observed, 0) < ALL { observed - &self.adds } else { observed.clone() }
    }

    /// Their largest part of the Allan variances from a scale on.
    fn most_of(&self, observed: &DVector<f64>, first: usize) -> f64 {
        self.adds.iter().zip(observed).skip(first).map(|(adds, all)| adds / all).fold(0.0, f64::max)
    }

    /// What is to be said of them after the fit to what is left of these Allan variances; nothing where they hardly matter.
    pub(super) fn vibration(
        &self,
        observed: &DVector<f64>,
        fit: &Regression,
        interval_s: f64,
    ) -> Option<Vibration> {
        let (of_white, of_tails) = (fit.part_of_white(&self.adds), fit.part_of_white(&self.tails));
        let sd = fit.relative_sd_of_white();
        let left_out = self.most_of(observed, 0) < ALL
            && self.most_of(observed, fit.first) < MOST
            && of_tails.abs() < sd;
        let matters = !left_out || self.share > SHARE || of_white > sd;
        let frequency_hz = self.frequency / interval_s;
        matters.then_some(Vibration { frequency_hz, share: self.share, of_white, left_out })
    }
}

/// What bins of these frequencies and variances add to the Allan variance of clusters of `m` samples.
fn allan_variance(bins: &[(f64, f64)], m: f64) -> f64 {
    let of_bin = |&(f, p): &(f64, f64)| 2.0 * p * (PI * f * m).sin().powi(4) / (m * (PI * f).sin()).powi(2);
    bins.iter().map(of_bin).sum()
}

/// `|Σ y e^{−2πi jk/n}|²` up to half the rate, of values that zeros make `n`, a power of two: the transform of half as many complex numbers, even values and odd ones.
fn periodogram(values: impl Iterator<Item = f64>, n: usize) -> Vec<f64> {
    let half = n / 2;
    let (mut re, mut im) = (vec![0.0; half], vec![0.0; half]);
    for (k, value) in values.enumerate() {
        if k % 2 == 0 { re[k / 2] = value } else { im[k / 2] = value }
    }
    transform(&mut re, &mut im);
    let power = |k: usize| {
        let (a, b) = (k % half, (half - k) % half);
        let even = [re[a] + re[b], im[a] - im[b]];
        let odd = [im[a] + im[b], re[b] - re[a]];
        let (sin, cos) = (-2.0 * PI * k as f64 / n as f64).sin_cos();
        let sum = [even[0] + odd[0] * cos - odd[1] * sin, even[1] + odd[0] * sin + odd[1] * cos];
        0.25 * (sum[0] * sum[0] + sum[1] * sum[1])
    };
    (0..=half).map(power).collect()
}

/// The Fourier transform of a power of two of complex numbers, in place.
fn transform(re: &mut [f64], im: &mut [f64]) {
    let n = re.len();
    let bits = n.ilog2();
    for k in 0..n {
        let other = k.reverse_bits().checked_shr(usize::BITS - bits).unwrap_or(0);
        if k < other {
            re.swap(k, other);
            im.swap(k, other);
        }
    }
    let mut half = 1;
    while half < n {
        let turn = -PI / half as f64;
        for j in 0..half {
            let (sin, cos) = (turn * j as f64).sin_cos();
            for a in (j..n).step_by(2 * half) {
                let b = a + half;
                let (x, y) = (re[b] * cos - im[b] * sin, re[b] * sin + im[b] * cos);
                (re[b], im[b]) = (re[a] - x, im[a] - y);
                (re[a], im[a]) = (re[a] + x, im[a] + y);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::PowerLaw;
    use crate::simulate::{Purpose, simulate_noise, stream};
    use std::f64::consts::TAU;

    #[test]
    fn the_periodogram_is_that_of_the_sum() {
        let values: Vec<f64> = (0..64).map(|k| f64::from(k * k % 17)).collect();
        for (k, power) in periodogram(values.iter().copied(), 64).into_iter().enumerate() {
            let part = |of: fn(f64) -> f64| -> f64 {
                values.iter().enumerate().map(|(j, y)| y * of(TAU * (j * k) as f64 / 64.0)).sum()
            };
            let expected = part(f64::cos).powi(2) + part(f64::sin).powi(2);
            assert!((power - expected).abs() < 1e-7 * (1.0 + expected), "{k}: {power} {expected}");
        }
    }

    #[test]
    fn a_hum_is_seen_and_noise_is_none() {
        let scales = [1, 2, 4, 8, 16];
        for seed in 0..40 {
            let noise = |process, coefficient| {
                simulate_noise(process, coefficient, 0.01, 10_000, &mut stream(seed, Purpose::Sensor, 0))
            };
            // the standard deviation of this white noise is 1
            let white = noise(PowerLaw::White, 0.1);
            let walk = noise(PowerLaw::RandomWalk, 3.0);
            let sum: Vec<f64> = white.iter().zip(&walk).map(|(one, other)| one + other).collect();
            let filtered: Vec<f64> = white.windows(5).map(|window| window.iter().sum()).collect();
            for values in [&white, &walk, &sum, &filtered] {
                assert!(Lines::of(values, &scales).is_none(), "{seed}");
            }
            for frequency in [0.0101, 0.03, 0.25, 0.4981] {
                let hum = |amplitude: f64, of: f64| -> Vec<f64> {
                    let add =
                        |(k, y): (usize, &f64)| of * y + amplitude * (TAU * frequency * k as f64 + 1.0).sin();
                    white.iter().enumerate().map(add).collect()
                };
                let found = Lines::of(&hum(0.4, 1.0), &scales).expect("seen");
                assert!((found.frequency - frequency).abs() < 1e-4, "{} {frequency}", found.frequency);
                // its standard deviation is √(4 · 0.08/n)
                assert!((found.share - 0.08 / 1.08).abs() < 4.5 * 0.0057, "{}", found.share);
                // far too small to matter
                assert!(Lines::of(&hum(0.01, 1.0), &scales).is_none(), "{seed}");
                // what it adds is the Allan variance of the sine alone
                let (found, mut x) = (Lines::of(&hum(1.0, 0.01), &scales).expect("seen"), vec![0.0]);
                for k in 0..10_000 {
                    x.push(x[k] + (TAU * frequency * k as f64 + 1.0).sin());
                }
                for (m, adds) in scales.into_iter().zip(&found.adds) {
                    let d = x.windows(2 * m + 1).map(|x| (x[2 * m] - 2.0 * x[m] + x[0]) / m as f64);
                    let sine = d.map(|d| d * d).sum::<f64>() / (2.0 * (10_001 - 2 * m) as f64);
                    assert!((adds - sine).abs() < 0.02 * sine + 1e-4, "{frequency} {m}: {adds} {sine}");
                }
            }
        }
    }
}
