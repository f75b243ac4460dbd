//! Vibration or hum: a line in the spectrum, which no sum of the processes has. In the Allan deviation it
//! looks like noise at some cluster times and like a filter at others.
//!
//! A line is a peak of the periodogram over the median about it. Ordinates of noise are exponential: one in
//! `e^x` is `x` times their mean, which is the median over `ln 2`. The excess of the bins about the peak over
//! that mean is the line's variance `p`, half the square of the amplitude of a sine. A frequency that wanders
//! spreads it over several bins. A line adds
//!
//! ```text
//! 2 p sin⁴(π f m)/(m² sin²(π f))
//! ```
//!
//! to the Allan variance of clusters of `m` samples, at the frequency `f` in cycles per sample. That is
//! subtracted before the fit. Leakage of a sine and a phase that walks at random both have tails that fall
//! like `1/k²` at the distance of `k` bins. The tail beyond `2k` bins is then as large as that between `k`
//! and `2k`, and is subtracted, too.
//!
//! # Where the noise is doubtful
//! The noise is doubtful where lines are most of the Allan variance at a fitted cluster time. It is also
//! doubtful where the tails of the lines, of which only the size is known, exceed the standard deviation of
//! N².

use super::allan_regression::Regression;
use super::series::Series;
use crate::fourier::Fourier;
use nalgebra::DVector;
use schemars::JsonSchema;
use serde::Serialize;
use std::f64::consts::{LN_2, PI};

/// Logarithm of the inverse probability of such a peak by chance, over all frequencies.
const BEYOND_CHANCE: f64 = 14.0;
/// A peak is the highest of this number of bins on each side.
const ABOUT: usize = 32;
/// The noise about a peak is the median of up to this number of bins on each side. It is at most half of the
/// peak's own number: closer to zero, slow noise is too steep.
const WIDELY: usize = 256;
/// Bins on each side that belong to a line.
const LINE: usize = 16;
/// The bins of a line beyond this distance are its tail.
const TAIL: usize = 8;
/// From this part of a fitted Allan variance on, lines are most of it.
const MOST: f64 = 0.5;
/// From this part of an Allan variance on, fitted or not, too little noise is left to be known.
const ALL: f64 = 0.97;
/// Lines are reported if they have this part of the variance of the samples.
const SHARE: f64 = 0.01;

/// Lines in the spectrum of an axis that are large enough to report.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Vibration {
    /// Frequency of the strongest line, Hz.
    pub frequency_hz: f64,
    /// Part of the variance of the samples that all lines have.
    pub share: f64,
    /// Part of N² that they would add if they were not subtracted.
    pub of_white: f64,
    /// Can they be subtracted so well that the noise is not doubtful?
    pub left_out: bool,
}

/// The contribution of the lines in the spectrum of some values to their Allan variances.
pub(super) struct Lines {
    /// Frequency of the strongest line, in cycles per sample.
    frequency: f64,
    /// Part of the variance of the values.
    share: f64,
    /// Their contribution at each scale.
    adds: DVector<f64>,
    /// The part of that beyond the bins of the lines.
    tails: DVector<f64>,
}

impl Lines {
    /// The lines that are beyond chance; `None` without any.
    pub(super) fn of(series: &Series, scales: &[usize], fourier: &Fourier) -> Option<Self> {
        if series.values.len() < 8 * ABOUT {
            return None;
        }
        let (count, mean, square) = (series.values.len() as f64, series.mean, series.square);
        let size = fourier.size();
        let spectrum = fourier.transform(series.values.iter().map(|value| value - mean));
        let powers: Vec<f64> = spectrum.iter().map(|sum| sum.norm_sqr()).collect();
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
            let (first, end) = near(k, WIDELY.min(k / 2)).into_inner();
            let about = [&powers[first..k - LINE], &powers[(k + LINE).min(end) + 1..=end]];
            let middle = about.iter().map(|side| side.len()).sum::<usize>() / 2;
            // most peaks are noise: counting the bins below the bound of a line is cheaper than taking the
            // median
            let least = powers[k] / beyond * LN_2;
            let below = |side: &&[f64]| side.iter().filter(|power| **power <= least).count();
            if about.iter().map(below).sum::<usize>() <= middle {
                continue;
            }
            let noise = *about.concat().select_nth_unstable_by(middle, f64::total_cmp).1 / LN_2;
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

    /// The Allan variances without the lines. They stay as they are where next to nothing would be left.
    pub(super) fn taken_off(&self, observed: &DVector<f64>) -> DVector<f64> {
        if self.most_of(observed, 0) < ALL { observed - &self.adds } else { observed.clone() }
    }

    /// The largest part of the Allan variances that lines have, from a scale on.
    fn most_of(&self, observed: &DVector<f64>, first: usize) -> f64 {
        self.adds.iter().zip(observed).skip(first).map(|(adds, all)| adds / all).fold(0.0, f64::max)
    }

    /// The report on the lines after the fit to these Allan variances without them. `None` where they do not
    /// matter.
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

/// The contribution of bins of these frequencies and variances to the Allan variance of clusters of `m`
/// samples.
fn allan_variance(bins: &[(f64, f64)], m: f64) -> f64 {
    let of_bin = |&(f, p): &(f64, f64)| 2.0 * p * (PI * f * m).sin().powi(4) / (m * (PI * f).sin()).powi(2);
    bins.iter().map(of_bin).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::PowerLaw;
    use crate::simulate::{Purpose, simulate_noise, stream};
    use std::f64::consts::TAU;

    #[test]
    fn a_hum_is_seen_and_noise_is_none() {
        let scales = [1, 2, 4, 8, 16];
        let lines = |values: &[f64]| {
            Lines::of(
                &Series::of(values.to_vec()),
                &scales,
                &Fourier::of_size(values.len().next_power_of_two()),
            )
        };
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
                assert!(lines(values).is_none(), "{seed}");
            }
            for frequency in [0.0101, 0.03, 0.25, 0.4981] {
                let hum = |amplitude: f64, of: f64| -> Vec<f64> {
                    let add =
                        |(k, y): (usize, &f64)| of * y + amplitude * (TAU * frequency * k as f64 + 1.0).sin();
                    white.iter().enumerate().map(add).collect()
                };
                let found = lines(&hum(0.4, 1.0)).expect("seen");
                assert!((found.frequency - frequency).abs() < 1e-4, "{} {frequency}", found.frequency);
                // its standard deviation is √(4 · 0.08/n)
                assert!((found.share - 0.08 / 1.08).abs() < 4.5 * 0.0057, "{}", found.share);
                // far too small to matter
                assert!(lines(&hum(0.01, 1.0)).is_none(), "{seed}");
                // the contribution is the Allan variance of the sine alone
                let (found, mut x) = (lines(&hum(1.0, 0.01)).expect("seen"), vec![0.0]);
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
