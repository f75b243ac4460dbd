//! What follows temperature: one quantity of each axis, a bias or a relative gain.
//!
//! A soak at the temperature `x` (−1 … 1 over the range), reached in the direction `d = ±1`, after a wait that leaves the share `e` of the lag, measures
//!
//! `q = Σ c_m P_m(x) + d/2 (1 − x²) (h_0 + h_1 x) + d e (l_0 + l_1 x) + u + ε`
//!
//! `h` is half the difference of the two branches, a loop that closes at both ends. `l` is the error at the end of a ramp, when the chip's thermometer and its
//! element are not at one temperature. `u ~ N(0, ω² + (r l_sd e)²)` does not average within a soak; `ε ~ N(0, σ²/n)` averages over its `n` blocks of holds.

use calibrant_core::sensor::legendre::legendre;
use calibrant_core::sensor::{Axis, ImuQuantity, Quantity, SensorKind};
use nalgebra::{DMatrix, DVector};

/// A quantity that follows temperature, alike on each axis, with what is known of it beforehand. All but `goal_sd` enters the information of a soak.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Its name: `accelerometer.bias`.
    pub name: String,
    /// Unit of all its standard deviations.
    pub unit: &'static str,
    /// Standard deviation of `c_0, c_1, …` over sensors of the type; `None`: nothing is known. Those above the order that is reported are what a polynomial of
    /// that order leaves out.
    pub spread: Vec<Option<f64>>,
    /// Standard deviation of `h_0, h_1`; empty: there is no hysteresis.
    pub hysteresis_sd: Vec<f64>,
    /// Standard deviation of `l_0, l_1`; empty: the thermometer does not lag.
    pub lag_sd: Vec<f64>,
    /// The share `r` of the lag's error that differs from soak to soak.
    pub lag_scatter: f64,
    /// `ω`: what does not average within a soak.
    pub soak_sd: f64,
    /// `σ`: of the quantity from one block of holds.
    pub block_sd: f64,
    /// The wanted standard deviation of the polynomial, on average over the range.
    pub goal_sd: f64,
}

impl Channel {
    /// Number of coefficients of the polynomial.
    #[must_use]
    pub fn polynomial(&self) -> usize {
        self.spread.len()
    }

    /// Number of the coefficients of which nothing is known.
    #[must_use]
    pub fn free(&self) -> usize {
        self.spread.iter().filter(|sd| sd.is_none()).count()
    }

    /// The parameters that it is of, one for each axis, by its name; none of a channel that is no bias and no gain.
    #[must_use]
    pub fn parameters(&self) -> Vec<ImuQuantity> {
        let Some((kind, part)) = self.name.split_once('.') else { return Vec::new() };
        let Some(kind) = SensorKind::ALL.into_iter().find(|of| of.name() == kind) else { return Vec::new() };
        let of = |axis: Axis| if part == "bias" { Quantity::Bias(axis) } else { Quantity::Scale(axis) };
        Axis::ALL.map(|axis| ImuQuantity::Of(kind, of(axis))).to_vec()
    }

    /// Number of all coefficients: polynomial, hysteresis, lag.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        self.spread.len() + self.hysteresis_sd.len() + self.lag_sd.len()
    }

    /// What the polynomial is at `x`, by its coefficients; zero for hysteresis and lag.
    #[must_use]
    pub fn polynomial_row(&self, x: f64) -> DVector<f64> {
        let mut row = legendre(x, self.polynomial());
        row.resize(self.coefficients(), 0.0);
        DVector::from_vec(row)
    }

    /// What a soak measures, by the coefficients. `direction`: +1 from below; `lag_left`: the share `e` of the lag that is left.
    #[must_use]
    pub fn row(&self, x: f64, direction: f64, lag_left: f64) -> DVector<f64> {
        let mut row = legendre(x, self.polynomial());
        let powers = |of: &[f64], factor: f64| -> Vec<f64> {
            (0..of.len()).map(|k| factor * x.powi(k as i32)).collect()
        };
        row.extend(powers(&self.hysteresis_sd, 0.5 * direction * (1.0 - x * x).max(0.0)));
        row.extend(powers(&self.lag_sd, direction * lag_left));
        DVector::from_vec(row)
    }

    /// The row on a branch as Legendre polynomials: `row(x) = Bᵀ legendre(x)`. Without a direction, the mean of both branches.
    #[must_use]
    pub fn on_branch(&self, direction: f64, lag_left: f64) -> DMatrix<f64> {
        if direction == 0.0 {
            return DMatrix::identity(self.polynomial(), self.coefficients());
        }
        let hysteresis = if self.hysteresis_sd.is_empty() { 0 } else { self.hysteresis_sd.len() + 2 };
        let count = self.polynomial().max(hysteresis).max(self.lag_sd.len());
        // through as many points as there are polynomials, and orthogonal there
        let nodes: Vec<f64> =
            (0..count).map(|k| (std::f64::consts::PI * (k as f64 + 0.5) / count as f64).cos()).collect();
        let values = DMatrix::from_fn(count, count, |i, j| legendre(nodes[i], count)[j]);
        let rows: Vec<_> = nodes.iter().map(|x| self.row(*x, direction, lag_left).transpose()).collect();
        values
            .lu()
            .solve(&DMatrix::from_rows(&rows))
            .unwrap_or_else(|| DMatrix::zeros(count, self.coefficients()))
    }

    /// What is known beforehand: the inverse variances of the coefficients.
    #[must_use]
    pub fn precision(&self) -> DMatrix<f64> {
        let of_polynomial = self.spread.iter().map(|sd| sd.map_or(0.0, |sd| sd.powi(-2)));
        let others = self.hysteresis_sd.iter().chain(&self.lag_sd).map(|sd| sd.powi(-2));
        DMatrix::from_diagonal(&DVector::from_iterator(self.coefficients(), of_polynomial.chain(others)))
    }

    /// Variance of what a soak measures, about the row: `ω² + (r l e)² + σ²/n`.
    #[must_use]
    pub fn variance(&self, blocks: usize, lag_left: f64) -> f64 {
        let lag = self.lag_sd.first().map_or(0.0, |sd| self.lag_scatter * sd * lag_left);
        self.soak_sd.powi(2) + lag.powi(2) + self.block_sd.powi(2) / blocks as f64
    }
}
