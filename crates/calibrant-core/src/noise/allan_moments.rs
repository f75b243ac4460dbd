//! Mean and covariance of the drift-free Allan variances of each process: the moments that the regression
//! uses.

use super::allan::{Confidence, Differences};
use super::power_law::FlickerTable;
use super::{PowerLaw, lag_sums};
use crate::fourier::Fourier;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Number of processes.
pub(super) const PROCESSES: usize = PowerLaw::ALL.len();
/// Number of pairs of processes.
const PAIRS: usize = PROCESSES * (PROCESSES + 1) / 2;

/// Mean and covariance of the drift-free Allan variances `ν_m` (see [the module](crate::noise)) of `n`
/// samples at `m = 1, 2, 4, … ≤ n/3`. They hold under each process with a coefficient and a sample interval
/// of 1. They depend on `n` alone: compute them once for recordings of one length.
///
/// `C_a(h)` is the covariance of differences `d_j(s)`, `d_k(s + h)` under process `a`. `⟨·⟩` is the mean over
/// all pairs of differences. Then
///
/// ```text
/// E ν_j = ½ Σ_a θ_a (C_a(0) − ⟨C_a⟩),    V^{ab}_{jk} = ½ ( ⟨C_a C_b⟩ − ⟨ρ_a ρ_b⟩ − ⟨κ_a κ_b⟩ + ⟨C_a⟩⟨C_b⟩ )
/// ```
///
/// where `ρ(s)`, `κ(t)` are the means of `C(t − s)` over `t` and over `s`. This is the covariance of
/// quadratic forms of Gaussian variables, `2 tr(P Σ P Σ)`, with the projector `P` that subtracts the mean.
#[derive(Debug, Clone)]
pub struct Moments {
    samples: usize,
    scales: Vec<usize>,
    /// `mean[(j, a)]`.
    mean: DMatrix<f64>,
    /// One matrix for each pair `a ≤ b`, in the order of [`pair`].
    covariance: Vec<DMatrix<f64>>,
    confidence: Confidence,
    fourier: Fourier,
}

/// Position of the pair of processes `a`, `b`.
fn pair(a: usize, b: usize) -> usize {
    let (a, b) = (a.min(b), a.max(b));
    a * PROCESSES - a * (a + 1) / 2 + b
}

/// `θ_a θ_b` of each pair, twice where they differ.
fn factors(theta: &[f64; PROCESSES]) -> [f64; PAIRS] {
    let mut factors = [0.0; PAIRS];
    for a in 0..PROCESSES {
        for b in a..PROCESSES {
            factors[pair(a, b)] = if a == b { 1.0 } else { 2.0 } * theta[a] * theta[b];
        }
    }
    factors
}

impl Moments {
    /// The moments for recordings of `n` samples, at least three.
    ///
    /// # Numerics
    /// Sums over lags take all lags where a covariance has a kink, and ever fewer away from there. That takes
    /// O(log² n) time for each pair of cluster times.
    #[must_use]
    pub fn of(n: usize) -> Self {
        let scales: Vec<usize> = (0..).map(|k| 1 << k).take_while(|m| 3 * m <= n).collect();
        let size = scales.len();
        let mut mean = DMatrix::zeros(size, PROCESSES);
        let mut covariance = vec![DMatrix::zeros(size, size); PAIRS];
        let places: Vec<(usize, usize)> = (0..size).flat_map(|j| (j..size).map(move |k| (j, k))).collect();
        let flicker = FlickerTable::of(n);
        let pair_of = |&(j, k): &(usize, usize)| Pair::of(n, scales[j], scales[k], &flicker);
        let (fourier, pairs): (_, Vec<Pair>) = rayon::join(
            || Fourier::of_size(n.next_power_of_two()),
            || places.par_iter().map(pair_of).collect(),
        );
        for (&(j, k), two) in places.iter().zip(&pairs) {
            for a in 0..PROCESSES {
                if j == k {
                    mean[(j, a)] = 0.5 * (two.at_zero[a] - two.mean[a]);
                }
                for b in a..PROCESSES {
                    let value = 0.5 * two.products[pair(a, b)];
                    covariance[pair(a, b)][(j, k)] = value;
                    covariance[pair(a, b)][(k, j)] = value;
                }
            }
        }
        Self { samples: n, scales, mean, covariance, confidence: Confidence::of(n), fourier }
    }

    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// The uncertainty of an Allan deviation of this number of samples.
    pub(super) fn confidence(&self) -> &Confidence {
        &self.confidence
    }

    /// The Fourier transform for this number of values.
    pub(super) fn fourier(&self) -> &Fourier {
        &self.fourier
    }

    /// The cluster sizes m.
    #[must_use]
    pub fn scales(&self) -> &[usize] {
        &self.scales
    }

    /// Column `a`: the mean under process `a`.
    pub(super) fn mean(&self) -> &DMatrix<f64> {
        &self.mean
    }

    /// Covariance of the variances at the scales from `first` on, under `θ`.
    pub(super) fn covariance(&self, theta: &[f64; PROCESSES], first: usize) -> DMatrix<f64> {
        let size = self.scales.len() - first;
        let mut sum = DMatrix::zeros(size, size);
        for (factor, matrix) in factors(theta).iter().zip(&self.covariance) {
            if *factor != 0.0 {
                sum.zip_apply(&matrix.view((first, first), (size, size)), |sum, value| {
                    *sum += value * factor
                });
            }
        }
        sum
    }

    /// The variance of a sum of the variances with these weights, at the scales from `first` on, as a function of `θ`.
    pub(super) fn variance_of_sum(
        &self,
        weights: &DVector<f64>,
        first: usize,
    ) -> impl Fn(&[f64; PROCESSES]) -> f64 + use<> {
        let size = weights.len();
        let of_pairs: [f64; PAIRS] = std::array::from_fn(|p| {
            let matrix = self.covariance[p].view((first, first), (size, size));
            matrix
                .column_iter()
                .zip(weights.iter())
                .map(|(column, weight)| column.dot(weights) * weight)
                .sum()
        });
        move |theta| factors(theta).iter().zip(&of_pairs).map(|(factor, value)| factor * value).sum()
    }

    /// The drift-free Allan variances of these values at the scales.
    pub(super) fn observe(&self, phase: &[f64]) -> DVector<f64> {
        DVector::from_iterator(
            self.scales.len(),
            self.scales.iter().map(|&m| 0.5 * Differences::of(phase, m).variance()),
        )
    }
}

/// Sums over all pairs of differences at two scales.
struct Pair {
    at_zero: [f64; PROCESSES],
    mean: [f64; PROCESSES],
    products: [f64; PAIRS],
}

impl Pair {
    fn of(n: usize, j: usize, k: usize, flicker: &FlickerTable) -> Self {
        let (count_j, count_k) = ((n - 2 * j + 1) as i64, (n - 2 * k + 1) as i64);
        let total = count_j as f64 * count_k as f64;
        let kinks: Vec<i64> = (0..3).flat_map(|p| (0..3).map(move |q| p * j as i64 - q * k as i64)).collect();
        let lags = lag_sums::around(&kinks, 1 - count_j, count_k - 1);
        let weights = lag_sums::weights(&lags);
        let curves: Vec<[f64; PROCESSES]> =
            lags.iter().map(|&lag| PowerLaw::covariances_of_differences(j, k, lag, flicker)).collect();

        let (mut mean, mut products) = ([0.0; PROCESSES], [0.0; PAIRS]);
        for ((&lag, weight), curve) in lags.iter().zip(&weights).zip(&curves) {
            let weight = weight * lag_sums::pairs(count_j, count_k, lag) / total;
            for a in 0..PROCESSES {
                mean[a] += weight * curve[a];
                for b in a..PROCESSES {
                    products[pair(a, b)] += weight * curve[a] * curve[b];
                }
            }
        }
        let integral = Integral::of(&lags, &curves);
        // ρ(s) is the mean of C over lags −s … count_k − 1 − s, κ(t) over t − count_j + 1 … t
        let rows = mean_products(count_j, 2 * k as i64, |s| integral.mean(-s, count_k - 1 - s));
        let columns = mean_products(count_k, 2 * j as i64, |t| integral.mean(t - count_j + 1, t));
        for a in 0..PROCESSES {
            for b in a..PROCESSES {
                let p = pair(a, b);
                products[p] += mean[a] * mean[b] - rows[p] - columns[p];
            }
        }
        let at_zero = PowerLaw::covariances_of_differences(j, k, 0, flicker);
        Self { at_zero, mean, products }
    }
}

/// Mean over `0 ≤ s < count` of the products of means, which bend within `edge` of both ends.
fn mean_products(count: i64, edge: i64, means: impl Fn(i64) -> [f64; PROCESSES]) -> [f64; PAIRS] {
    let last = count - 1;
    let places = lag_sums::around(&[0, edge.min(last), (last - edge).max(0), last], 0, last);
    let weights = lag_sums::weights(&places);
    let mut sum = [0.0; PAIRS];
    for (&place, weight) in places.iter().zip(&weights) {
        let mean = means(place);
        for a in 0..PROCESSES {
            for b in a..PROCESSES {
                sum[pair(a, b)] += weight / count as f64 * mean[a] * mean[b];
            }
        }
    }
    sum
}

/// Running sums of curves over all lags.
struct Integral<'a> {
    lags: &'a [i64],
    curves: &'a [[f64; PROCESSES]],
    /// Sum over the lags before each, with half of its own value.
    sums: Vec<[f64; PROCESSES]>,
    /// Slope from each lag to the next.
    slopes: Vec<[f64; PROCESSES]>,
}

impl<'a> Integral<'a> {
    fn of(lags: &'a [i64], curves: &'a [[f64; PROCESSES]]) -> Self {
        let mut sums = vec![[0.0; PROCESSES]; lags.len()];
        let mut slopes = sums.clone();
        for i in 1..lags.len() {
            let step = (lags[i] - lags[i - 1]) as f64;
            for a in 0..PROCESSES {
                let (before, after) = (curves[i - 1][a], curves[i][a]);
                sums[i][a] = sums[i - 1][a] + 0.5 * step * (before + after);
                slopes[i - 1][a] = (after - before) / step;
            }
        }
        Self { lags, curves, sums, slopes }
    }

    /// Curves and running sums at a lag.
    fn at(&self, lag: i64) -> [(f64, f64); PROCESSES] {
        let i = self.lags.partition_point(|&l| l <= lag).clamp(1, self.lags.len() - 1);
        let x = (lag - self.lags[i - 1]) as f64;
        let (before, slope, sums) = (&self.curves[i - 1], &self.slopes[i - 1], &self.sums[i - 1]);
        std::array::from_fn(|a| {
            let value = before[a] + slope[a] * x;
            (value, sums[a] + 0.5 * x * (before[a] + value))
        })
    }

    /// Means over the lags `from ..= to`.
    fn mean(&self, from: i64, to: i64) -> [f64; PROCESSES] {
        let (from_values, to_values) = (self.at(from), self.at(to));
        std::array::from_fn(|a| {
            let ((first, before), (last, after)) = (from_values[a], to_values[a]);
            (after - before + 0.5 * (first + last)) / (to - from + 1) as f64
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same by dense matrices.
    fn dense(n: usize, j: usize, k: usize, a: PowerLaw, b: PowerLaw) -> (f64, f64) {
        let sigma = |process: PowerLaw, j: usize, k: usize| {
            let at = |s: usize, t: usize| process.covariance_of_differences(j, k, t as i64 - s as i64);
            DMatrix::from_fn(n - 2 * j + 1, n - 2 * k + 1, at)
        };
        let centre = |matrix: DMatrix<f64>| {
            let (rows, columns) = matrix.shape();
            let p = |size: usize| DMatrix::identity(size, size).add_scalar(-1.0 / size as f64);
            p(rows) * matrix * p(columns)
        };
        let (first, second) = (centre(sigma(a, j, k)), centre(sigma(b, j, k)));
        let covariance = 0.5 * first.dot(&second) / (first.nrows() * first.ncols()) as f64;
        let own = centre(sigma(a, j, j));
        (0.5 * own.trace() / own.nrows() as f64, covariance)
    }

    #[test]
    fn moments_are_those_of_dense_matrices() {
        let n = 400;
        let moments = Moments::of(n);
        assert_eq!(moments.scales(), [1, 2, 4, 8, 16, 32, 64, 128]);
        for (j, k) in [(0, 0), (0, 3), (2, 2), (3, 6), (5, 5), (6, 7), (7, 7), (0, 7)] {
            for (p, &a) in PowerLaw::ALL.iter().enumerate() {
                for (q, &b) in PowerLaw::ALL.iter().enumerate() {
                    let (mean, covariance) = dense(n, moments.scales[j], moments.scales[k], a, b);
                    let found = moments.mean[(j, p)];
                    assert!((found / mean - 1.0).abs() < 2e-3, "{a:?}: {found} {mean}");
                    let found = moments.covariance[pair(p, q)][(j, k)];
                    let sd = |p: usize, s: usize| moments.covariance[pair(p, p)][(s, s)].sqrt();
                    let size = (sd(p, j) * sd(p, k) * sd(q, j) * sd(q, k)).sqrt();
                    // one per cent of a standard deviation where a scale has few more lags than the sum takes
                    assert!(
                        (found - covariance).abs() < 2e-2 * size,
                        "{a:?} {b:?} {j} {k}: {found} {covariance} {size}"
                    );
                }
            }
        }
    }
}
