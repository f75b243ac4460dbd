//! Fits a spline to a log by least squares: with gaps, repeated samples, outliers and uneven times.
//!
//! `minimise Σ_k w_k (x_k − x(t_k))² + λ Σ_i (Δ³c_i)²`. The weights `w` are Huber's, about the median absolute deviation of the residuals (`huber1981`).
//! The penalty is so small that it only decides where no sample does: a gap is bridged by a parabola.

use super::{UniformKnots, VectorSpline, Weights};
use crate::log::{rounding_sd, step_of};
use rayon::prelude::*;

/// Residuals up to this many standard deviations keep their full weight.
const HUBER: f64 = 4.0;
/// Residuals beyond this many standard deviations are outliers, and count as such.
const OUTLIER: f64 = 8.0;
/// From this round on outliers have no weight.
const REDESCENDING: usize = 3;
/// The weights have settled when none changes by more than this.
const SETTLED: f64 = 0.05;
/// Samples whose residuals have the same standard deviation.
const NEIGHBOURS: usize = 100;
/// Reweighted fits.
const ROUNDS: usize = 8;
/// Residuals below this part of the values are rounding.
const ROUNDING: f64 = 1e-13;
/// Weight of the penalty beside that of the samples.
const PENALTY: f64 = 1e-12;
/// Median absolute deviation of a normal distribution with standard deviation 1.
const NORMAL_MAD: f64 = 0.674_489_75;

/// A spline through a log.
#[derive(Debug, Clone)]
pub struct SplineFit {
    /// The spline.
    pub spline: VectorSpline,
    /// Standard deviation of one sample about the spline, for each component. The degrees of freedom that the fit used are counted.
    pub sd: Vec<f64>,
    /// Number of outliers of each component.
    pub outliers: Vec<usize>,
    /// Standard deviation of the rounding of each component, where its values have a step; 0 elsewhere. The noise is at least this.
    pub rounding_sd: Vec<f64>,
}

/// Fits a vector to samples, `dimension` values for each time. A value that is NaN was not recorded.
///
/// # Examples
/// ```
/// use calibrant_machine::spline::{Degree, UniformKnots, fit_vectors};
/// let times: Vec<f64> = (0..500).map(|k| 0.01 * k as f64).collect();
/// let noise = |t: f64| 1e-4 * (1e4 * t).sin();
/// let mut values: Vec<f64> = times.iter().map(|t| (2.0 * t).sin() + noise(*t)).collect();
/// values[100] = 50.0; // an outlier
/// values[200..210].fill(f64::NAN); // a gap
/// let knots = UniformKnots::covering(0.0, 4.99, 0.1, Degree::Quintic);
/// let fit = fit_vectors(&times, &values, 1, knots);
/// assert_eq!(fit.outliers, [1]);
/// assert!((fit.spline.at(1.0, 1)[0] - 2.0 * 2.0_f64.cos()).abs() < 1e-3);
/// ```
#[must_use]
pub fn fit_vectors(times_s: &[f64], values: &[f64], dimension: usize, knots: UniformKnots) -> SplineFit {
    let weights: Vec<Weights> = times_s.iter().map(|t| knots.weights(*t)).collect();
    let mut fit = SplineFit {
        spline: VectorSpline { knots, dimension, controls: vec![0.0; dimension * knots.controls()] },
        sd: Vec::new(),
        outliers: Vec::new(),
        rounding_sd: Vec::new(),
    };
    let fitted = |j: usize| {
        let samples: Vec<Sample<'_>> = (weights.iter().zip(values[j..].iter().step_by(dimension)))
            .filter(|(_, value)| value.is_finite())
            .map(|(weights, &value)| Sample { weights, value })
            .collect();
        Component::fitted(&samples, knots)
    };
    let components: Vec<Component> = (0..dimension).into_par_iter().map(fitted).collect();
    for (j, of) in components.into_iter().enumerate() {
        for (i, control) in of.controls.iter().enumerate() {
            fit.spline.controls[i * dimension + j] = *control;
        }
        fit.sd.push(of.sd);
        fit.outliers.push(of.outliers);
        fit.rounding_sd.push(of.rounding_sd);
    }
    fit
}

struct Sample<'a> {
    weights: &'a Weights,
    value: f64,
}

impl Sample<'_> {
    fn residual(&self, controls: &[f64]) -> f64 {
        let Weights { interval, order, derivative } = self.weights;
        let fitted: f64 = (0..*order).map(|r| derivative[0][r] * controls[interval + r]).sum();
        self.value - fitted
    }
}

struct Component {
    controls: Vec<f64>,
    sd: f64,
    outliers: usize,
    rounding_sd: f64,
}

impl Component {
    fn fitted(samples: &[Sample<'_>], knots: UniformKnots) -> Self {
        let mut weight = vec![1.0; samples.len()];
        let rounding_sd = rounding_sd(step_of(samples.iter().map(|sample| sample.value)));
        let mut fit = Self { controls: vec![0.0; knots.controls()], sd: 0.0, outliers: 0, rounding_sd };
        // rounding is no residual
        let largest = samples.iter().fold(0.0_f64, |largest, sample| largest.max(sample.value.abs()));
        let floor = rounding_sd.max(ROUNDING * largest.max(f64::MIN_POSITIVE / ROUNDING));
        for round in 0..ROUNDS {
            let (factor, controls) = solved(samples, &weight, knots);
            fit.controls = controls;
            let residuals: Vec<f64> = samples.iter().map(|sample| sample.residual(&fit.controls)).collect();
            let scale = scales(&residuals, floor);
            let before = weight.clone();
            for ((weight, residual), scale) in weight.iter_mut().zip(&residuals).zip(&scale) {
                *weight = match residual.abs() / scale {
                    size if size <= HUBER => 1.0,
                    size if size > OUTLIER && round >= REDESCENDING => 0.0,
                    size => HUBER / size,
                };
            }
            let settled = before.iter().zip(&weight).all(|(one, other)| (one - other).abs() < SETTLED)
                && (round > REDESCENDING || weight.iter().all(|weight| *weight > HUBER / OUTLIER));
            if settled || round + 1 == ROUNDS {
                // control points that the samples determine: the trace of the hat matrix
                let determined = trace(samples, &before, &factor);
                let squares: f64 = residuals.iter().zip(&before).map(|(r, w)| w * w * r * r).sum();
                let degrees = (samples.len() as f64 - determined).max(1.0);
                fit.sd = (squares / degrees).sqrt().max(rounding_sd);
                fit.outliers =
                    residuals.iter().zip(&scale).filter(|(r, scale)| r.abs() > OUTLIER * **scale).count();
                break;
            }
        }
        fit
    }
}

/// Factor and solution of the normal equations.
fn solved(samples: &[Sample<'_>], weight: &[f64], knots: UniformKnots) -> (Band, Vec<f64>) {
    let mut band = Band::zeros(knots.controls(), knots.degree.order());
    let mut right = vec![0.0; knots.controls()];
    for (sample, weight) in samples.iter().zip(weight) {
        let Weights { interval, order, derivative } = sample.weights;
        for r in 0..*order {
            let weighted = weight * derivative[0][r];
            right[interval + r] += weighted * sample.value;
            for (s, other) in derivative[0].iter().enumerate().take(r + 1) {
                band.add(interval + r, interval + s, weighted * other);
            }
        }
    }
    let penalty = PENALTY * (samples.len() as f64 / knots.intervals as f64).max(1.0);
    for i in 0..knots.controls() - 3 {
        let difference = [-1.0, 3.0, -3.0, 1.0];
        for r in 0..4 {
            for s in 0..=r {
                band.add(i + r, i + s, penalty * difference[r] * difference[s]);
            }
        }
    }
    let factor = band.cholesky();
    factor.solve(&mut right);
    (factor, right)
}

/// Trace of the hat matrix.
fn trace(samples: &[Sample<'_>], weight: &[f64], factor: &Band) -> f64 {
    let inverse = factor.inverse_band();
    let leverage = |(sample, weight): (&Sample<'_>, &f64)| {
        let Weights { interval, order, derivative } = sample.weights;
        let mut sum = 0.0;
        for r in 0..*order {
            for s in 0..=r {
                let twice = if r == s { 1.0 } else { 2.0 };
                sum += twice * derivative[0][r] * derivative[0][s] * inverse.get(interval + r, interval + s);
            }
        }
        weight * sum
    };
    samples.iter().zip(weight).map(leverage).sum()
}

/// Standard deviation of the residuals about each sample: of the samples near it, or of all if that is larger. A tracker's error grows with motion.
fn scales(residuals: &[f64], floor: f64) -> Vec<f64> {
    let of = |residuals: &[f64]| median(residuals.iter().map(|r| r.abs()).collect()) / NORMAL_MAD;
    let all = of(residuals).max(floor);
    residuals.chunks(NEIGHBOURS).flat_map(|near| std::iter::repeat_n(of(near).max(all), near.len())).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Lower band of a symmetric matrix: row `i` has the entries of columns `i − width + 1 … i`.
#[derive(Debug, Clone)]
pub(super) struct Band {
    width: usize,
    rows: Vec<f64>,
}

impl Band {
    pub(super) fn zeros(size: usize, width: usize) -> Self {
        Self { width, rows: vec![0.0; size * width] }
    }

    pub(super) fn size(&self) -> usize {
        self.rows.len() / self.width
    }

    fn place(&self, i: usize, j: usize) -> usize {
        i * self.width + (self.width - 1 + j - i)
    }

    /// Entry (i, j) with `i − width < j ≤ i`.
    pub(super) fn get(&self, i: usize, j: usize) -> f64 {
        self.rows[self.place(i, j)]
    }

    pub(super) fn add(&mut self, i: usize, j: usize, value: f64) {
        let place = self.place(i, j);
        self.rows[place] += value;
    }

    fn first(&self, i: usize) -> usize {
        (i + 1).saturating_sub(self.width)
    }

    /// The Cholesky factor `L`, `A = L Lᵀ`. A pivot that vanishes by rounding becomes one that fixes its unknown.
    pub(super) fn cholesky(mut self) -> Self {
        for i in 0..self.size() {
            for j in self.first(i)..=i {
                let begin = self.first(i).max(self.first(j));
                let sum: f64 = (begin..j).map(|k| self.get(i, k) * self.get(j, k)).sum();
                let place = self.place(i, j);
                let rest = self.rows[place] - sum;
                self.rows[place] = if i == j {
                    if rest > 1e-14 * self.rows[place].abs() { rest.sqrt() } else { f64::INFINITY }
                } else {
                    rest / self.get(j, j)
                };
            }
        }
        self
    }

    /// Solves `L Lᵀ x = b` in place, with this as `L`.
    pub(super) fn solve(&self, b: &mut [f64]) {
        for i in 0..b.len() {
            let sum: f64 = (self.first(i)..i).map(|k| self.get(i, k) * b[k]).sum();
            b[i] = (b[i] - sum) / self.get(i, i);
        }
        for i in (0..b.len()).rev() {
            b[i] /= self.get(i, i);
            for k in self.first(i)..i {
                b[k] -= self.get(i, k) * b[i];
            }
        }
    }

    /// The band of `(L Lᵀ)⁻¹`, with this as `L` (`takahashi1973`).
    pub(super) fn inverse_band(&self) -> Self {
        let size = self.size();
        let mut inverse = Self::zeros(size, self.width);
        for j in (0..size).rev() {
            let last = (j + self.width).min(size);
            for i in (j..last).rev() {
                let symmetric = |inverse: &Self, a: usize, b: usize| inverse.get(a.max(b), a.min(b));
                let sum: f64 = (j + 1..last).map(|k| self.get(k, j) * symmetric(&inverse, i, k)).sum();
                let own = if i == j { 1.0 / self.get(j, j) } else { 0.0 };
                inverse.add(i, j, (own - sum) / self.get(j, j));
            }
        }
        inverse
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn it_equals_dense_algebra() {
        let (size, width) = (9, 4);
        let mut band = Band::zeros(size, width);
        for i in 0..size {
            for j in (i + 1_usize).saturating_sub(width)..=i {
                band.add(i, j, if i == j { 5.0 } else { ((3 * i + 7 * j) as f64).sin() });
            }
        }
        let near = |i: usize, j: usize| i.abs_diff(j) < width;
        let dense =
            DMatrix::from_fn(size, size, |i, j| if near(i, j) { band.get(i.max(j), i.min(j)) } else { 0.0 });
        let b = DVector::from_fn(size, |i, _| i as f64 - 3.0);
        let factor = band.cholesky();
        let mut x = b.as_slice().to_vec();
        factor.solve(&mut x);
        let inverse = dense.try_inverse().expect("it is diagonally dominant");
        assert!((&inverse * b - DVector::from_vec(x)).norm() < 1e-13);
        let of_band = factor.inverse_band();
        for i in 0..size {
            for j in (0..=i).filter(|j| near(i, *j)) {
                assert!((inverse[(i, j)] - of_band.get(i, j)).abs() < 1e-13);
            }
        }
    }
}
