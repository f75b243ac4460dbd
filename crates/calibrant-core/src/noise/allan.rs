//! The overlapping Allan deviation of readings, with its confidence bounds.

use super::series::{mean, phase};
use super::variance_interval::CONFIDENCE;
use super::{PowerLaw, lag_sums};
use crate::error::{Error, InputError, Refusal, Result};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::sync::OnceLock;

/// Cluster times in a decade.
const PER_DECADE: f64 = 12.0;
/// Fewest samples.
const FEWEST: usize = 9;

/// The overlapping Allan deviation of one axis at cluster times spread evenly on a logarithmic scale.
///
/// # Examples
/// A case by hand: `d = (y₂ − y₁, …)`, `σ² = ½ mean d²`.
/// ```
/// use calibrant_core::noise::AllanDeviation;
///
/// let allan = AllanDeviation::of(&[1.0, 3.0, 2.0, 6.0, 4.0, 4.0, 5.0, 3.0, 5.0], 0.1)?;
/// let first = &allan.points[0];
/// // differences 2, −1, 4, −2, 0, 1, −2, 2: mean square 34/8
/// assert!((first.deviation - (34.0_f64 / 16.0).sqrt()).abs() < 1e-12 && first.tau_s == 0.1);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct AllanDeviation {
    /// Time between samples, s.
    pub interval_s: f64,
    /// Number of samples.
    pub samples: usize,
    /// The points in order of cluster time, from one sample to a third of the recording.
    pub points: Vec<AllanPoint>,
}

/// The Allan deviation at one cluster time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AllanPoint {
    /// Samples in a cluster, m.
    pub cluster: usize,
    /// Cluster time τ, s.
    pub tau_s: f64,
    /// σ(τ), in the unit of the readings.
    pub deviation: f64,
    /// The process that dominates there, by the lag-1 autocorrelation of the cluster means. Slopes of a sum
    /// of processes only rise with the cluster time, so the slope is never lower than before. With fewer than
    /// 30 clusters it is the process of the previous cluster time.
    pub process: PowerLaw,
    /// Equivalent degrees of freedom of σ² under this process.
    pub degrees_of_freedom: f64,
    /// Lower 95 % confidence bound of σ.
    pub low: f64,
    /// Upper 95 % confidence bound of σ.
    pub high: f64,
}

impl AllanDeviation {
    /// The Allan deviation of readings at equal intervals. It takes O(n) time for each of about 12 cluster
    /// times in a decade.
    ///
    /// The bounds are `σ̂² edf/χ²` with the quantiles of the χ² distribution (IEEE 952, `riley2008`).
    ///
    /// # Errors
    /// [`Error::Recording`] for fewer than nine samples, or where a reading is not finite.
    pub fn of(readings: &[f64], interval_s: f64) -> Result<Self> {
        let phase = phase(readings, mean(readings));
        Self::with_confidence(readings, &phase, interval_s, &Confidence::of(readings.len()))
    }

    /// The same with their [phase], and the [`Confidence`] for their number, already computed.
    pub(super) fn with_confidence(
        readings: &[f64],
        phase: &[f64],
        interval_s: f64,
        confidence: &Confidence,
    ) -> Result<Self> {
        let n = readings.len();
        if n < FEWEST {
            return Err(Error::recording(InputError::new(
                Refusal::NoiseUndetermined,
                format!("an Allan deviation of {n} samples says nothing"),
                format!("it takes {FEWEST} at least, and thousands to be of use"),
            )));
        }
        if readings.iter().any(|reading| !reading.is_finite()) || interval_s <= 0.0 || !interval_s.is_finite()
        {
            return Err(Error::recording(InputError::new(
                Refusal::NoiseUndetermined,
                "an Allan deviation needs finite readings at a positive interval",
                "leave out what is missing",
            )));
        }
        let mut process = PowerLaw::ALL[0];
        let points = confidence
            .clusters
            .iter()
            .map(|cluster| {
                // nothing is steeper than a random walk
                if process < PowerLaw::RandomWalk {
                    process = process.max(identify(phase, cluster.size).unwrap_or(PowerLaw::White));
                }
                AllanPoint::of(phase, interval_s, cluster.size, process, cluster.spread(n, process))
            })
            .collect();
        Ok(Self { interval_s, samples: n, points })
    }
}

impl AllanPoint {
    fn of(phase: &[f64], interval_s: f64, m: usize, process: PowerLaw, spread: Spread) -> Self {
        let deviation = (0.5 * Differences::of(phase, m).mean_square()).sqrt();
        let (low, high) = (deviation * spread.low, deviation * spread.high);
        let degrees_of_freedom = spread.degrees_of_freedom;
        Self { cluster: m, tau_s: m as f64 * interval_s, deviation, process, degrees_of_freedom, low, high }
    }
}

/// The uncertainty of the Allan deviation of a given number of samples, at each cluster time and under each
/// process. It is computed once for all axes, when it is first needed.
#[derive(Debug, Clone)]
pub(super) struct Confidence {
    clusters: Vec<Cluster>,
}

#[derive(Debug, Clone)]
struct Cluster {
    size: usize,
    spreads: [OnceLock<Spread>; PowerLaw::ALL.len()],
}

/// Degrees of freedom of a variance, and the confidence bounds of its root, relative to the root.
#[derive(Debug, Clone, Copy)]
struct Spread {
    degrees_of_freedom: f64,
    low: f64,
    high: f64,
}

impl Confidence {
    /// For `n` samples.
    pub(super) fn of(n: usize) -> Self {
        let cluster = |size| Cluster { size, spreads: Default::default() };
        Self { clusters: cluster_sizes(n).into_iter().map(cluster).collect() }
    }
}

impl Cluster {
    fn spread(&self, n: usize, process: PowerLaw) -> Spread {
        *self.spreads[process as usize].get_or_init(|| {
            let degrees_of_freedom = degrees_of_freedom(process, n, self.size);
            let tail = 0.5 * (1.0 - CONFIDENCE);
            let (low, high) = ChiSquared::new(degrees_of_freedom).map_or((0.0, f64::INFINITY), |chi2| {
                let bound = |p: f64| (degrees_of_freedom / chi2.inverse_cdf(p)).sqrt();
                (bound(1.0 - tail), bound(tail))
            });
            Spread { degrees_of_freedom, low, high }
        })
    }
}

/// Differences of the means of adjacent clusters of `m` samples, at every start.
pub(super) struct Differences {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Differences {
    pub(super) fn of(phase: &[f64], m: usize) -> Self {
        // side by side: the processor needs several cycles for a sum, and adds two or more at once
        const LANES: usize = 4;
        let count = phase.len() - 2 * m;
        let (mut sums, mut squares) = ([0.0; LANES], [0.0; LANES]);
        let mut add = |lane: usize, before: f64, at: f64, after: f64| {
            let d = after - 2.0 * at + before;
            sums[lane] += d;
            squares[lane] += d * d;
        };
        let from = |start: usize| phase[start..start + count].as_chunks::<LANES>();
        let (before, at, after) = (from(0), from(m), from(2 * m));
        for ((before, at), after) in before.0.iter().zip(at.0).zip(after.0) {
            for lane in 0..LANES {
                add(lane, before[lane], at[lane], after[lane]);
            }
        }
        for (lane, ((before, at), after)) in before.1.iter().zip(at.1).zip(after.1).enumerate() {
            add(lane, *before, *at, *after);
        }
        let size = m as f64;
        let (sum, squares) = (sums.iter().sum::<f64>() / size, squares.iter().sum::<f64>() / (size * size));
        Self { count: count as f64, sum, squares }
    }

    pub(super) fn mean_square(&self) -> f64 {
        self.squares / self.count
    }

    /// Variance of the differences about their mean, which a linear drift shifts.
    pub(super) fn variance(&self) -> f64 {
        self.mean_square() - (self.sum / self.count).powi(2)
    }
}

fn cluster_sizes(n: usize) -> Vec<usize> {
    let mut sizes: Vec<usize> = (0..)
        .map(|k| 10_f64.powf(f64::from(k) / PER_DECADE).round() as usize)
        .take_while(|m| 3 * m <= n)
        .collect();
    sizes.dedup();
    sizes
}

fn identify(phase: &[f64], m: usize) -> Option<PowerLaw> {
    let starts = || phase.chunks(m).map(|cluster| cluster[0]);
    let means: Vec<f64> = starts().zip(starts().skip(1)).map(|(a, b)| (b - a) / m as f64).collect();
    PowerLaw::identify(&means)
}

/// Equivalent degrees of freedom of the overlapping Allan variance of `n` samples at clusters of `m`:
/// `M² C(0)² / Σ_h (M − |h|) C(h)²`. `C` is the autocovariance of the differences (`greenhall2003`).
fn degrees_of_freedom(process: PowerLaw, n: usize, m: usize) -> f64 {
    let count = (n - 2 * m + 1) as i64;
    let kinks = [0, m as i64, 2 * m as i64];
    let lags = lag_sums::around(&kinks, 0, count - 1);
    let at = |lag: i64| process.covariance_of_differences(m, m, lag);
    // both signs: lag zero counts once
    let sum: f64 = lags
        .iter()
        .zip(lag_sums::weights(&lags))
        .map(|(&lag, weight)| 2.0 * weight * lag_sums::pairs(count, count, lag) * at(lag).powi(2))
        .sum::<f64>()
        - count as f64 * at(0).powi(2);
    ((count as f64 * at(0)).powi(2) / sum).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_worked_by_hand() {
        let allan =
            AllanDeviation::of(&[1.0, 3.0, 2.0, 6.0, 4.0, 4.0, 5.0, 3.0, 5.0], 1.0).expect("long enough");
        let sizes: Vec<usize> = allan.points.iter().map(|point| point.cluster).collect();
        assert_eq!(sizes, [1, 2, 3]);
        // clusters of two: sums 4 5 8 10 8 9 8 8, differences at distance two (8−4, 10−5, 8−8, 9−10, 8−8, 8−9)/2
        let two = (4.0_f64.powi(2) + 25.0 + 0.0 + 1.0 + 0.0 + 1.0) / 4.0 / 12.0;
        assert!((allan.points[1].deviation - two.sqrt()).abs() < 1e-12);
        // clusters of three: sums 6 11 12 14 13 12 13, differences at distance three (14−6, 13−11, 12−12, 13−14)/3
        let three = (64.0 + 4.0 + 0.0 + 1.0) / 9.0 / 8.0;
        assert!((allan.points[2].deviation - f64::sqrt(three)).abs() < 1e-12);
    }

    #[test]
    fn degrees_of_freedom_are_those_of_the_handbook() {
        // riley2008, section 5.4: for N phase points; exact for white noise but for the ends, approximate for the others
        for (n, m) in [(1000_usize, 1_usize), (1000, 10), (10_000, 64), (1000, 200)] {
            let (points, size) = (n as f64 + 1.0, m as f64);
            let white =
                (3.0 * (points - 1.0) / (2.0 * size) - 2.0 * (points - 2.0) / points) * 4.0 * size * size
                    / (4.0 * size * size + 5.0);
            let found = degrees_of_freedom(PowerLaw::White, n, m);
            assert!(
                (found / white - 1.0).abs() < if 100 * m < n { 0.01 } else { 0.08 },
                "white {n} {m}: {found} {white}"
            );
            let walk = (points - 2.0) / size
                * ((points - 1.0).powi(2) - 3.0 * size * (points - 1.0) + 4.0 * size * size)
                / (points - 3.0).powi(2);
            let found = degrees_of_freedom(PowerLaw::RandomWalk, n, m);
            assert!((found / walk - 1.0).abs() < 0.16, "random walk {n} {m}: {found} {walk}");
            let flicker = match m {
                1 => 2.0 * (points - 2.0) / (2.3 * points - 4.9),
                _ => 5.0 * points * points / (4.0 * size * (points + 3.0 * size)),
            } * if m == 1 { points } else { 1.0 };
            let found = degrees_of_freedom(PowerLaw::Flicker, n, m);
            assert!(m == 1 || (found / flicker - 1.0).abs() < 0.16, "flicker {n} {m}: {found} {flicker}");
        }
    }

    #[test]
    fn a_large_mean_takes_no_digits() {
        let readings: Vec<f64> = (0..1000).map(|k| f64::from(k * 7919 % 101)).collect();
        let shifted: Vec<f64> = readings.iter().map(|y| y + 1e9).collect();
        let (a, b) = (AllanDeviation::of(&readings, 1.0), AllanDeviation::of(&shifted, 1.0));
        for (a, b) in a.expect("valid").points.iter().zip(b.expect("valid").points) {
            assert!((a.deviation / b.deviation - 1.0).abs() < 1e-6, "{a:?} {b:?}");
        }
    }

    #[test]
    fn too_few_samples_are_refused() {
        let error = AllanDeviation::of(&[1.0; 8], 1.0).expect_err("too few");
        assert!(error.is_invalid_recording() && error.to_string().contains("8 samples"), "{error}");
    }
}
