//! The piecewise linear function through samples, with knots at even times that are fitted as well.
//!
//! The periods that knots may have, from the second differences of even samples.
//!
//! The second difference of a piecewise linear function is 0 but next to a knot. So its size has a line in its
//! spectrum at the frequency of the knots, or at the alias of it.

use calibrant_core::fourier::Fourier;
use nalgebra::{Matrix2, Vector2, Vector3};

/// A little weight towards 0 for nodes that no sample determines.
const RIDGE: f64 = 1e-9;
/// Largest step of the first knot in one iteration, in periods.
const LARGEST_STEP: f64 = 0.1;
/// Largest change of the period in one iteration, relative.
const LARGEST_CHANGE: f64 = 0.01;
/// Most iterations, and most halvings of a step in one.
const ITERATIONS: usize = 12;
const HALVINGS: i32 = 8;
/// Relative gain below which the knots have converged.
const CONVERGED: f64 = 1e-6;

/// Even times: that of knot `j` is `reference_s + j period_s`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Knots {
    pub(super) reference_s: f64,
    pub(super) period_s: f64,
}

impl Knots {
    pub(super) fn at(&self, knot: i64) -> f64 {
        self.reference_s + knot as f64 * self.period_s
    }

    /// The knot before a time, and how far the time is on the way to the next one, 0 to 1.
    pub(super) fn place(&self, t: f64) -> (i64, f64) {
        let place = (t - self.reference_s) / self.period_s;
        let knot = place.floor();
        (knot as i64, place - knot)
    }

    pub(super) fn shifted(&self, by_s: f64) -> Self {
        Self { reference_s: self.reference_s + by_s, ..*self }
    }
}

/// Samples among knots: the equations for the values at the knots, which are tridiagonal.
pub(super) struct Nodes {
    /// Number of the first node.
    pub(super) first: i64,
    /// For each sample the node before it, counted from the first, and the weight of the node after it.
    places: Vec<(usize, f64)>,
    diagonal: Vec<f64>,
    beside: Vec<f64>,
}

impl Nodes {
    /// The nodes that samples at these times, which do not decrease, have around them.
    pub(super) fn of(times_s: &[f64], knots: &Knots) -> Self {
        let ends = [times_s.first(), times_s.last()].map(|t| t.map_or(0, |t| knots.place(*t).0));
        let [first, last] = ends;
        let length = (last - first + 2).max(2) as usize;
        let (mut diagonal, mut beside) = (vec![RIDGE; length], vec![0.0; length - 1]);
        let place = |&t: &f64| {
            let (knot, weight) = knots.place(t);
            let node = ((knot - first).max(0) as usize).min(length - 2);
            diagonal[node] += (1.0 - weight).powi(2);
            diagonal[node + 1] += weight.powi(2);
            beside[node] += weight * (1.0 - weight);
            (node, weight)
        };
        let places = times_s.iter().map(place).collect();
        Self { first, places, diagonal, beside }
    }

    pub(super) fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// The nodes of a sample, and the weight of the second.
    pub(super) fn place(&self, sample: usize) -> (usize, f64) {
        self.places[sample]
    }

    /// The value at a sample.
    pub(super) fn value(&self, nodes: &[Vector3<f64>], sample: usize) -> Vector3<f64> {
        let (node, weight) = self.places[sample];
        nodes[node] * (1.0 - weight) + nodes[node + 1] * weight
    }

    /// The least-squares values at the nodes for these values of the samples.
    pub(super) fn solve(&self, values: impl Iterator<Item = Vector3<f64>>) -> Vec<Vector3<f64>> {
        let mut solution = vec![Vector3::zeros(); self.len()];
        for (&(node, weight), value) in self.places.iter().zip(values) {
            solution[node] += value * (1.0 - weight);
            solution[node + 1] += value * weight;
        }
        let mut pivots = self.diagonal.clone();
        for node in 1..self.len() {
            let factor = self.beside[node - 1] / pivots[node - 1];
            pivots[node] -= factor * self.beside[node - 1];
            solution[node] = solution[node] - solution[node - 1] * factor;
        }
        for node in (0..self.len()).rev() {
            if let Some(next) = solution.get(node + 1).copied() {
                solution[node] -= next * self.beside[node];
            }
            solution[node] /= pivots[node];
        }
        solution
    }

    /// The information that the samples give of each node, where that of one sample at the node is 1.
    pub(super) fn information(&self) -> Vec<f64> {
        let length = self.len();
        let (mut below, mut above) = (self.diagonal.clone(), self.diagonal.clone());
        for node in 1..length {
            below[node] -= self.beside[node - 1].powi(2) / below[node - 1];
            let back = length - 1 - node;
            above[back] -= self.beside[back].powi(2) / above[back + 1];
        }
        (0..length).map(|node| below[node] + above[node] - self.diagonal[node]).collect()
    }
}

/// Knots and how well they fit.
#[derive(Debug, Clone, Copy)]
pub(super) struct KnotFit {
    pub(super) knots: Knots,
    /// Root mean square of the distance from the samples.
    pub(super) rms: f64,
    /// Standard deviation of the period, s.
    pub(super) period_sd_s: f64,
}

/// Root mean square of the distance between samples and the best function with these knots.
pub(super) fn rms(times_s: &[f64], values: &[Vector3<f64>], knots: &Knots) -> f64 {
    let nodes = Nodes::of(times_s, knots);
    let solution = nodes.solve(values.iter().copied());
    let squares =
        values.iter().enumerate().map(|(k, value)| (value - nodes.value(&solution, k)).norm_squared());
    (squares.sum::<f64>() / values.len() as f64).sqrt()
}

/// Moves the knots to where they fit best: Gauss–Newton with the values at the nodes eliminated.
pub(super) fn fit(times_s: &[f64], values: &[Vector3<f64>], start: &Knots) -> KnotFit {
    let mut knots = *start;
    for _ in 0..ITERATIONS {
        let (before, step, _) = step(times_s, values, &knots);
        let share = |largest: f64, step: f64| largest * knots.period_s / step.abs().max(f64::MIN_POSITIVE);
        let whole = share(LARGEST_STEP, step.x).min(share(LARGEST_CHANGE, step.y)).min(1.0);
        // the distance has corners where a knot passes a sample: a step may be too long
        let shares = (0..HALVINGS).map(|halvings| whole * 0.5_f64.powi(halvings));
        let tried = shares.map(|share| Knots {
            reference_s: knots.reference_s + share * step.x,
            period_s: knots.period_s + share * step.y,
        });
        let better = tried.map(|knots| (rms(times_s, values, &knots), knots)).find(|(rms, _)| *rms < before);
        let Some((after, moved)) = better else { break };
        knots = moved;
        if before - after < CONVERGED * before {
            break;
        }
    }
    let (rms, _, period_sd_s) = step(times_s, values, &knots);
    KnotFit { knots, rms, period_sd_s }
}

/// Root mean square with these knots, the step of reference and period to better ones, and the standard deviation
/// of the period.
fn step(times_s: &[f64], values: &[Vector3<f64>], knots: &Knots) -> (f64, Vector2<f64>, f64) {
    let nodes = Nodes::of(times_s, knots);
    let solution = nodes.solve(values.iter().copied());
    // the values' derivatives with respect to reference and period, with the nodes kept
    let derivative = |k: usize| {
        let (node, weight) = nodes.place(k);
        let slope = (solution[node + 1] - solution[node]) / knots.period_s;
        let knot = (node as i64 + nodes.first) as f64 + weight;
        [-slope, -slope * knot]
    };
    let of_nodes = [0, 1].map(|which| nodes.solve((0..times_s.len()).map(|k| derivative(k)[which])));
    let (mut information, mut gradient, mut squares) = (Matrix2::zeros(), Vector2::zeros(), 0.0);
    for (k, value) in values.iter().enumerate() {
        let residual = value - nodes.value(&solution, k);
        // what the nodes cannot take up of them
        let left = [0, 1].map(|which| derivative(k)[which] - nodes.value(&of_nodes[which], k));
        for row in 0..2 {
            gradient[row] += left[row].dot(&residual);
            for column in 0..2 {
                information[(row, column)] += left[row].dot(&left[column]);
            }
        }
        squares += residual.norm_squared();
    }
    let covariance = information.try_inverse().unwrap_or_default();
    let free = (3 * values.len()).saturating_sub(3 * nodes.len() + 2).max(1) as f64;
    let rms = (squares / values.len() as f64).sqrt();
    (rms, covariance * gradient, (squares / free * covariance[(1, 1)]).sqrt())
}

/// Samples over which the size of the second differences is averaged.
const AVERAGED: usize = 129;
/// Least and largest number of samples for each knot. With fewer, a piecewise linear function follows vibration at
/// some frequencies to the last decimal.
const RATIOS: std::ops::RangeInclusive<f64> = 1.4..=60.0;
/// Lines of the spectrum that are tried.
const LINES: usize = 4;

/// Second differences of even samples.
pub(super) fn second_differences(values: &[Vector3<f64>]) -> Vec<f64> {
    values.array_windows().map(|[before, value, after]| (after - value * 2.0 + before).norm()).collect()
}

/// Periods in samples, the longest first.
pub(super) fn periods(values: &[Vector3<f64>]) -> Vec<f64> {
    let sizes = second_differences(values);
    let spectrum = spectrum(&sizes);
    let is_peak = |bin: usize| {
        spectrum[bin] >= spectrum[bin - 1] && spectrum.get(bin + 1).is_none_or(|next| spectrum[bin] > *next)
    };
    let mut peaks: Vec<usize> = (2..spectrum.len()).filter(|&bin| is_peak(bin)).collect();
    peaks.sort_by(|&one, &other| spectrum[other].total_cmp(&spectrum[one]));
    peaks.truncate(LINES);
    let samples = (2 * (spectrum.len() - 1)) as f64;
    let frequency = |bin: usize| {
        let (before, after) =
            (spectrum[bin - 1], spectrum.get(bin + 1).copied().unwrap_or(spectrum[bin - 1]));
        let curvature = before - 2.0 * spectrum[bin] + after;
        let off = if curvature < 0.0 { 0.5 * (before - after) / curvature } else { 0.0 };
        (bin as f64 + off) / samples
    };
    let of_line = |bin: usize| {
        let frequency = frequency(bin);
        // the line may be the second harmonic, or the alias of a frequency above half the sample rate
        [0.5 * frequency, frequency, 0.5 * (1.0 - frequency), 1.0 - frequency].map(f64::recip)
    };
    // knots at every second sample have no line where they are halfway between samples
    let mut periods: Vec<f64> = peaks.into_iter().flat_map(of_line).chain([2.0]).collect();
    periods.retain(|period| RATIOS.contains(period));
    periods.sort_by(|one, other| other.total_cmp(one));
    periods
}

/// Amplitudes of the sizes less their local mean, over it.
fn spectrum(sizes: &[f64]) -> Vec<f64> {
    let mean = |k: usize| {
        let around = &sizes[k.saturating_sub(AVERAGED / 2)..(k + AVERAGED / 2 + 1).min(sizes.len())];
        around.iter().sum::<f64>() / around.len() as f64
    };
    let length = sizes.len() & !1;
    let window = |k: usize| (std::f64::consts::PI * (k as f64 + 0.5) / length as f64).sin().powi(2);
    let input = (0..length).map(|k| {
        let mean = mean(k);
        if mean > 0.0 { window(k) * (sizes[k] / mean - 1.0) } else { 0.0 }
    });
    Fourier::of_size(length).transform(input).iter().map(|line| line.norm()).collect()
}
