//! A vibration or a hum: a line in the spectrum, which no sum of the processes has. In the Allan deviation it looks like noise at some cluster times and like a filter at others.
//!
//! The line is the highest peak of the periodogram over the median about it. Ordinates of noise are exponential: one in `e^x` is `x` times their mean, which is the median over `ln 2`.
//! A line of amplitude `a` has `a² n/(4 σ²)`. It adds to the Allan variance most at `τ = 0.37/f`, `0.525 a²`, where white noise has `σ² τ₀/τ`.

use std::f64::consts::{LN_2, PI};

/// Logarithm of the inverse probability of such a peak by chance, over all frequencies.
const BEYOND_CHANCE: f64 = 14.0;
/// Ordinates on each side with whose median a peak is compared,
const ABOUT: usize = 32;
/// but for these, which a line between two frequencies leaks into.
const LEAKS: usize = 4;
/// A line is worth doubt if it adds this part to the Allan variance of white noise where it adds most,
const ADDS: f64 = 0.1;
/// or this part to the variance of the samples.
const SHARE: f64 = 0.02;

/// The frequency, in cycles per sample, of a line that spoils the white noise.
pub(super) fn find(values: &[f64]) -> Option<f64> {
    if values.len() < 8 * ABOUT {
        return None;
    }
    let size = 1 << values.len().ilog2();
    let part = &values[..size];
    let mean = part.iter().sum::<f64>() / size as f64;
    let powers = periodogram(part.iter().map(|value| value - mean).collect());
    // closer to zero the spectrum of slow noise is too steep for a median, and a line is not looked for
    let ratio = |k: usize| {
        let mut about: Vec<f64> = (k - ABOUT..=(k + ABOUT).min(powers.len() - 1))
            .filter(|other| other.abs_diff(k) > LEAKS)
            .map(|other| powers[other])
            .collect();
        let middle = about.len() / 2;
        let mean = *about.select_nth_unstable_by(middle, f64::total_cmp).1 / LN_2;
        (powers[k] / mean, mean)
    };
    let is_highest = |&k: &usize| {
        powers[k - ABOUT..=(k + ABOUT).min(powers.len() - 1)].iter().all(|other| *other <= powers[k])
    };
    let peaks = (2 * ABOUT..powers.len()).filter(is_highest).map(|k| (k, ratio(k)));
    let candidate = peaks.max_by(|one, other| one.1.0.total_cmp(&other.1.0));
    let (k, (peak, noise)) = candidate?;
    let frequency = k as f64 / size as f64;
    if peak < (size as f64).ln() + BEYOND_CHANCE || noise <= 0.0 {
        return None;
    }
    // of the line, with what leaks: amplitude² over the variance of a sample
    let line: f64 = powers[k - 1..=(k + 1).min(powers.len() - 1)].iter().sum::<f64>() / noise;
    let square = 4.0 * line / size as f64;
    let adds = 0.525 * 0.37 * square / frequency;
    (adds > ADDS || 0.5 * square > SHARE).then_some(frequency)
}

/// `|Σ y e^{−2πi jk/n}|²` up to half the rate, of a power of two of values.
fn periodogram(mut re: Vec<f64>) -> Vec<f64> {
    let n = re.len();
    let mut im = vec![0.0; n];
    let bits = n.ilog2();
    for k in 0..n {
        let other = k.reverse_bits() >> (usize::BITS - bits);
        if k < other {
            re.swap(k, other);
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
    (0..=n / 2).map(|k| re[k] * re[k] + im[k] * im[k]).collect()
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
        for (k, power) in periodogram(values.clone()).into_iter().enumerate() {
            let part = |of: fn(f64) -> f64| -> f64 {
                values.iter().enumerate().map(|(j, y)| y * of(TAU * (j * k) as f64 / 64.0)).sum()
            };
            let expected = part(f64::cos).powi(2) + part(f64::sin).powi(2);
            assert!((power - expected).abs() < 1e-7 * (1.0 + expected), "{k}: {power} {expected}");
        }
    }

    #[test]
    fn a_hum_is_seen_and_noise_is_none() {
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
                assert_eq!(find(values), None, "{seed}");
            }
            for frequency in [0.0101, 0.03, 0.25, 0.4981] {
                let hum = |amplitude: f64| -> Vec<f64> {
                    let add =
                        |(k, y): (usize, &f64)| y + amplitude * (TAU * frequency * k as f64 + 1.0).sin();
                    white.iter().enumerate().map(add).collect()
                };
                let found = find(&hum(0.4)).expect("seen");
                assert!((found - frequency).abs() < 2e-4, "{found} {frequency}");
                // far too small to matter
                assert_eq!(find(&hum(0.01)), None, "{seed}");
            }
        }
    }
}
