//! The rate of a recorded temperature, by a parabola about each time.

use crate::estimate::holds::median;
use crate::sensor::interpolated;
use nalgebra::{Matrix3, Vector3};

/// The temperature is averaged over so long before its rate is taken, s.
const AVERAGED_S: f64 = 1.0;

/// A parabola reaches so far to both sides, s, and further where the temperature moved by fewer steps than these.
const REACH_S: f64 = 15.0;
const STEPS: f64 = 3.0;

/// A thermometer is coarse or slow where it shows one value for this many samples in a row.
const STAYS: usize = 3;

/// dT/dt at each sample, K/s.
pub(crate) fn temperature_rates(times_s: &[f64], values_c: &[f64]) -> Vec<f64> {
    let (times, means) = averaged(times_s, values_c);
    let step_k = step_of(values_c);
    let duration_s = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
    let rates: Vec<f64> = times
        .iter()
        .map(|&at_s| {
            let mut reach_s = REACH_S;
            loop {
                let first = times.partition_point(|&t| t < at_s - reach_s);
                let end = times.partition_point(|&t| t <= at_s + reach_s);
                let span = means[first..end]
                    .iter()
                    .fold([f64::MAX, f64::MIN], |[low, high], &t| [low.min(t), high.max(t)]);
                if span[1] - span[0] >= STEPS * step_k || reach_s > duration_s {
                    return slope_at(at_s, reach_s, &times[first..end], &means[first..end]);
                }
                reach_s *= 1.5;
            }
        })
        .collect();
    times_s.iter().map(|&t| interpolated(&times, |k| rates[k], t, 0).unwrap_or(0.0)).collect()
}

/// Means of times and values over equal intervals.
fn averaged(times_s: &[f64], values_c: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let Some(&start_s) = times_s.first() else { return (Vec::new(), Vec::new()) };
    let samples: Vec<(f64, f64)> = times_s.iter().copied().zip(values_c.iter().copied()).collect();
    let interval = |t: f64| ((t - start_s) / AVERAGED_S).floor();
    samples
        .chunk_by(|one, other| interval(one.0) == interval(other.0))
        .map(|of| {
            let count = of.len() as f64;
            let (time, value) = of.iter().fold((0.0, 0.0), |(time, value), (t, v)| (time + t, value + v));
            (time / count, value / count)
        })
        .unzip()
}

/// Usual change between values that stay for some samples, K; 0 of a fine thermometer that is read with each sample.
fn step_of(values_c: &[f64]) -> f64 {
    let staying: Vec<f64> = values_c
        .chunk_by(|one, other| one == other)
        .filter(|run| run.len() >= STAYS)
        .map(|run| run[0])
        .collect();
    let changes: Vec<f64> =
        staying.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|change| *change > 0.0).collect();
    if changes.is_empty() { 0.0 } else { median(changes) }
}

/// The slope at a time of the parabola of least squares; 0 where there is none.
fn slope_at(at_s: f64, reach_s: f64, times_s: &[f64], values_c: &[f64]) -> f64 {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    let middle = values_c.first().copied().unwrap_or(0.0);
    for (t, value) in times_s.iter().zip(values_c) {
        let x = (t - at_s) / reach_s;
        let row = Vector3::new(1.0, x, x * x);
        normal += row * row.transpose();
        right += row * (value - middle);
    }
    normal.cholesky().map_or(0.0, |factor| factor.solve(&right)[1] / reach_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A warm-up by 20 K with a time constant of 90 s.
    fn warm_up(shown: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        (0..27_000).map(|k| f64::from(k) * 0.01).map(|t| (t, shown(44.0 - 20.0 * (-t / 90.0).exp()))).unzip()
    }

    fn worst(shown: impl Fn(f64) -> f64) -> f64 {
        let (times, values) = warm_up(shown);
        let rates = temperature_rates(&times, &values);
        times
            .iter()
            .zip(rates)
            .map(|(t, rate)| (rate - 20.0 / 90.0 * (-t / 90.0).exp()).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn rates_are_those_of_the_temperature_whether_it_is_fine_or_in_steps() {
        // before the first mean, half a second from the begin, the rate stays: 0.5 · 20/90² K/s; and a parabola is no exponential
        assert!(worst(|t| t) < 2e-3, "{}", worst(|t| t));
        // of 0.22 K/s at the begin
        assert!(worst(f64::round) < 0.05, "{}", worst(f64::round));
        assert_eq!(temperature_rates(&[0.0, 1.0], &[20.0, 20.0]), [0.0, 0.0]);
        assert!(temperature_rates(&[], &[]).is_empty());
    }
}
