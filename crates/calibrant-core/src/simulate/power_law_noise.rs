//! Simulated noise of a sensor at rest, with a power-law spectrum.

use super::Rng;
use crate::noise::PowerLaw;
use rand_distr::{Distribution, StandardNormal};

/// `n` readings at intervals of `interval_s` of one random process with this coefficient (see [`PowerLaw`]),
/// in the unit of the coefficient.
///
/// Flicker noise is the fractional sum of order ½ of white noise (`kasdin1995`), from rest: O(n²).
///
/// # Examples
/// ```
/// use calibrant_core::noise::PowerLaw;
/// use calibrant_core::simulate::{Purpose, simulate_noise, stream};
///
/// let readings = simulate_noise(PowerLaw::RandomWalk, 0.1, 0.01, 1000, &mut stream(1, Purpose::Sensor, 0));
/// assert_eq!(readings.len(), 1000);
/// ```
pub fn simulate_noise(
    process: PowerLaw,
    coefficient: f64,
    interval_s: f64,
    n: usize,
    rng: &mut Rng,
) -> Vec<f64> {
    let mut white = |sd: f64| -> f64 { sd * Distribution::<f64>::sample(&StandardNormal, &mut *rng) };
    match process {
        PowerLaw::Quantisation => {
            let mut before = white(coefficient);
            (0..n)
                .map(|_| {
                    let now = white(coefficient);
                    let reading = (now - before) / interval_s;
                    before = now;
                    reading
                })
                .collect()
        }
        PowerLaw::White => (0..n).map(|_| white(coefficient / interval_s.sqrt())).collect(),
        PowerLaw::RandomWalk => {
            let mut value = 0.0;
            (0..n)
                .map(|_| {
                    value += white(coefficient * interval_s.sqrt());
                    value
                })
                .collect()
        }
        PowerLaw::Flicker => {
            let mut weights = vec![1.0; n];
            for k in 1..n {
                weights[k] = weights[k - 1] * (k as f64 - 0.5) / k as f64;
            }
            let input: Vec<f64> = (0..n).map(|_| white(coefficient)).collect();
            (0..n)
                .map(|k| weights[..=k].iter().zip(input[..=k].iter().rev()).map(|(w, x)| w * x).sum())
                .collect()
        }
    }
}
