//! The random processes whose sum is the noise of a sensor at rest: their Allan variances and covariances.

use std::borrow::Cow;
use std::f64::consts::{LN_2, PI};

/// A random process with a power-law spectrum; each has its slope in an Allan deviation plot.
///
/// # Examples
/// ```
/// use calibrant_core::noise::PowerLaw;
///
/// assert_eq!(PowerLaw::White.slope(), -0.5);
/// // flicker noise of B = 1 has a flat Allan deviation of 0.664
/// assert!((PowerLaw::Flicker.allan_variance(1000.0).sqrt() - 0.664).abs() < 1e-3);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PowerLaw {
    /// White noise of the angle or velocity, coefficient Q.
    Quantisation,
    /// White noise of the reading, coefficient N: angle or velocity random walk.
    White,
    /// Flicker noise of the reading, coefficient B: bias instability.
    Flicker,
    /// Random walk of the reading, coefficient K: rate random walk.
    RandomWalk,
}

/// Beyond this multiple of the longer cluster, the flicker covariance is its asymptote: the exact expression
/// loses its digits there.
const FAR: f64 = 50.0;

impl PowerLaw {
    /// All processes, in the order of their slopes.
    pub const ALL: [Self; 4] = [Self::Quantisation, Self::White, Self::Flicker, Self::RandomWalk];

    /// Slope of the Allan deviation on logarithmic axes.
    #[must_use]
    pub fn slope(self) -> f64 {
        [-1.0, -0.5, 0.0, 0.5][self as usize]
    }

    /// Letter of its coefficient.
    #[must_use]
    pub fn letter(self) -> char {
        ['Q', 'N', 'B', 'K'][self as usize]
    }

    /// Allan variance at cluster time `τ` for a coefficient of 1, the textbook's continuous form (see [the module](crate::noise)).
    #[must_use]
    pub fn allan_variance(self, tau_s: f64) -> f64 {
        match self {
            Self::Quantisation => 3.0 / (tau_s * tau_s),
            Self::White => 1.0 / tau_s,
            Self::Flicker => 2.0 * LN_2 / PI,
            Self::RandomWalk => tau_s / 3.0,
        }
    }

    /// Power of the sample interval. The square of the coefficient times this is the square for an interval
    /// of 1.
    pub(super) fn interval_power(self) -> i32 {
        [-2, -1, 0, 1][self as usize]
    }

    /// Generalised autocovariance of the summed readings `x` at a lag of whole samples, for a coefficient and
    /// a sample interval of 1.
    ///
    /// Generalised: up to even polynomials of degree two, which differences of clusters remove. Each is exact
    /// for its sequence. The sequences are white `y`, a sum of white steps, and the fractional sum of order ½
    /// of white noise for flicker noise (`kasdin1995`). Its generalised autocovariance is
    /// `−(2/π) Σ_{i ≤ |h|} 1/(2i − 1)`; summed twice it is `(4h² − 1)/(8π) ψ(|h| + ½)`.
    fn phase_covariance(self, lag: f64) -> f64 {
        let h = lag.abs();
        match self {
            Self::Quantisation => f64::from(u8::from(h == 0.0)),
            Self::White => -0.5 * h,
            Self::Flicker => flicker_phase_covariance(h),
            Self::RandomWalk => (h * h * h - h) / 12.0,
        }
    }

    /// `E d_j(s) d_k(s + lag)` for a coefficient and a sample interval of 1. The differences are between
    /// adjacent clusters of `j` and of `k` samples that begin at `s` and `s + lag`.
    pub(super) fn covariance_of_differences(self, j: usize, k: usize, lag: i64) -> f64 {
        let sum = || second_differences(j, k, lag, |h| [self.phase_covariance(h)]);
        self.far_apart(j, k, lag).unwrap_or_else(|| sum()[0])
    }

    /// The same for all processes. The flicker noise's comes from a table: it alone is not zero where
    /// clusters do not touch.
    pub(super) fn covariances_of_differences(
        j: usize,
        k: usize,
        lag: i64,
        flicker: &FlickerTable,
    ) -> [f64; 4] {
        if Self::White.far_apart(j, k, lag).is_some() {
            let sum = || second_differences(j, k, lag, |h| [flicker.at(h)])[0];
            return [0.0, 0.0, Self::Flicker.far_apart(j, k, lag).unwrap_or_else(sum), 0.0];
        }
        second_differences(j, k, lag, |h| {
            Self::ALL.map(|process| match process {
                Self::Flicker => flicker.at(h),
                _ => process.phase_covariance(h),
            })
        })
    }

    /// The covariance of clusters that are far apart, where a simple form holds.
    fn far_apart(self, j: usize, k: usize, lag: i64) -> Option<f64> {
        let (j, k, h) = (j as f64, k as f64, lag as f64);
        if self == Self::Flicker {
            let apart = h + k - j;
            return (apart.abs() > FAR * j.max(k)).then(|| -j * k / (PI * apart * apart));
        }
        // clusters that do not touch
        (h > 2.0 * j || h < -2.0 * k).then_some(0.0)
    }

    /// The process that dominates the difference of adjacent clusters, by the lag-1 autocorrelation of the
    /// cluster means (`riley2004`).
    ///
    /// `None` for fewer than 30 clusters: too few to decide.
    #[must_use]
    pub fn identify(means: &[f64]) -> Option<Self> {
        /// Fewest clusters.
        const FEWEST: usize = 30;
        let mut values = Cow::Borrowed(means);
        let mut differences = 0.0;
        loop {
            if values.len() < FEWEST {
                return None;
            }
            let r = lag_one_correlation(&values);
            if !r.is_finite() {
                return None;
            }
            let order = r / (1.0 + r);
            if order < 0.25 || differences >= 1.0 {
                // spectrum of the reading ∝ f^α
                let alpha = -2.0 * (order + differences);
                return Some(match alpha.round() as i32 {
                    1.. => Self::Quantisation,
                    0 => Self::White,
                    -1 => Self::Flicker,
                    _ => Self::RandomWalk,
                });
            }
            values = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
            differences += 1.0;
        }
    }
}

/// Autocorrelation of at least two values at lag one.
fn lag_one_correlation(values: &[f64]) -> f64 {
    // side by side: the processor needs several cycles for a sum, and adds two or more at once
    const LANES: usize = 4;
    let (chunks, rest) = values.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    chunks.iter().for_each(|chunk| (0..LANES).for_each(|lane| sums[lane] += chunk[lane]));
    let mean = sums.iter().chain(rest).sum::<f64>() / values.len() as f64;
    let (mut squares, mut products) = ([0.0; LANES], [0.0; LANES]);
    let mut add = |lane: usize, one: f64, next: f64| {
        squares[lane] += (one - mean) * (one - mean);
        products[lane] += (one - mean) * (next - mean);
    };
    let (last, next) = (values[values.len() - 1], values[1..].as_chunks::<LANES>());
    let (chunks, rest) = values[..values.len() - 1].as_chunks::<LANES>();
    for (one, next) in chunks.iter().zip(next.0) {
        (0..LANES).for_each(|lane| add(lane, one[lane], next[lane]));
    }
    rest.iter().zip(next.1).for_each(|(one, next)| add(0, *one, *next));
    products.iter().sum::<f64>() / (squares.iter().sum::<f64>() + (last - mean).powi(2))
}

/// Covariances of differences between clusters from those of the phase.
fn second_differences<const N: usize>(
    j: usize,
    k: usize,
    lag: i64,
    phase_covariances: impl Fn(f64) -> [f64; N],
) -> [f64; N] {
    /// Weights of a second difference.
    const SECOND_DIFFERENCE: [f64; 3] = [1.0, -2.0, 1.0];
    let (j, k, h) = (j as f64, k as f64, lag as f64);
    let mut sums = [0.0; N];
    for (p, u) in SECOND_DIFFERENCE.iter().enumerate() {
        for (q, v) in SECOND_DIFFERENCE.iter().enumerate() {
            let covariances = phase_covariances(h + q as f64 * k - p as f64 * j);
            sums.iter_mut().zip(covariances).for_each(|(sum, covariance)| *sum += u * v * covariance);
        }
    }
    sums.map(|sum| sum / (j * k))
}

/// Autocovariances of the phase of flicker noise at the lags that are needed repeatedly: each takes a
/// logarithm.
pub(super) struct FlickerTable(Vec<f64>);

impl FlickerTable {
    /// Longest table: 512 KiB.
    const LONGEST: usize = 1 << 16;

    /// For recordings of `n` samples.
    pub(super) fn of(n: usize) -> Self {
        Self((0..=n.min(Self::LONGEST)).map(|h| flicker_phase_covariance(h as f64)).collect())
    }

    fn at(&self, lag: f64) -> f64 {
        let h = lag.abs();
        self.0.get(h as usize).copied().unwrap_or_else(|| flicker_phase_covariance(h))
    }
}

fn flicker_phase_covariance(h: f64) -> f64 {
    (4.0 * h * h - 1.0) / (8.0 * PI) * digamma_of_half_integer(h)
}

/// `ψ(h + ½)` of a whole number `h ≥ 0`.
fn digamma_of_half_integer(h: f64) -> f64 {
    /// From this argument on, the asymptotic series is exact to rounding.
    const ASYMPTOTIC: f64 = 12.0;
    if h >= ASYMPTOTIC {
        let square = 1.0 / (h * h);
        return h.ln() + square * (1.0 / 24.0 - square * (7.0 / 960.0 - square * 31.0 / 8064.0));
    }
    // ψ(½) = −γ − 2 ln 2, ψ(x + 1) = ψ(x) + 1/x
    const EULER: f64 = 0.577_215_664_901_532_9;
    (0..h as usize).map(|i| 1.0 / (i as f64 + 0.5)).sum::<f64>() - EULER - 2.0 * LN_2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variance(process: PowerLaw, m: usize) -> f64 {
        0.5 * process.covariance_of_differences(m, m, 0)
    }

    #[test]
    fn allan_variances_are_those_of_the_sequences() {
        for m in [1_usize, 2, 7, 64, 4096] {
            let x = m as f64;
            assert!((variance(PowerLaw::Quantisation, m) * x * x - 3.0).abs() < 1e-12);
            assert!((variance(PowerLaw::White, m) * x - 1.0).abs() < 1e-12);
            let walk = (2.0 * x * x + 1.0) / (6.0 * x);
            assert!((variance(PowerLaw::RandomWalk, m) / walk - 1.0).abs() < 1e-9, "{m}");
        }
        // a fractional sum of order ½ differenced once has the variance 4/π
        assert!((2.0 * variance(PowerLaw::Flicker, 1) - 4.0 / PI).abs() < 1e-12);
        assert!((variance(PowerLaw::Flicker, 1000) - 2.0 * LN_2 / PI).abs() < 1e-5);
    }

    #[test]
    fn long_cluster_times_have_the_textbook_form() {
        for process in PowerLaw::ALL {
            let ratio = variance(process, 10_000) / process.allan_variance(10_000.0);
            assert!((ratio - 1.0).abs() < 1e-6, "{process:?}: {ratio}");
        }
    }

    #[test]
    fn the_far_flicker_covariance_continues_the_near_one() {
        for (j, k) in [(1, 1), (4, 64), (64, 64)] {
            let edge = (FAR * 64_f64.min(j.max(k) as f64)) as i64 + j as i64 - k as i64;
            let (near, far) = (
                PowerLaw::Flicker.covariance_of_differences(j, k, edge),
                PowerLaw::Flicker.covariance_of_differences(j, k, edge + 1),
            );
            assert!((near / far - 1.0).abs() < 0.05, "{j}, {k}: {near} {far}");
        }
    }
}
