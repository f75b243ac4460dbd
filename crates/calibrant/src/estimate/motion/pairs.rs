//! Products of the places of samples a few steps apart: what the whiteness test needs to know of the fit.
//!
//! Residuals of a fit are correlated even where the noise is white: their covariance is `σ² (I − P)` with the hat matrix `P`. Its l-th
//! off-diagonal sum `c_l = Σ_k P_{k,k+l}` is what the l-th autocovariance is short of. `P_{k,m}` is the covariance of the fitted
//! readings at two samples, bilinear in their places `λ`, so c_l needs only these sums for each interval, once for all axes.

use super::moments::Position;
use nalgebra::Matrix2;

/// Largest lag of the whiteness test.
const LAGS: usize = 10;

/// Sums of `(1 − λ_k, λ_k)ᵀ (1 − λ_m, λ_m)` over the pairs `m = k + l` whose later sample lies in one interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct PairSum {
    /// Pairs within the interval.
    pub(super) within: Matrix2<f64>,
    /// Pairs that begin in the interval before.
    pub(super) across: Matrix2<f64>,
}

/// The sums for each interval and lag.
pub(super) struct PairSums {
    /// Number of lags L: 10, or the samples of an interval if fewer, so that no pair spans more than two intervals.
    pub(super) lags: usize,
    sums: Vec<PairSum>,
}

impl PairSums {
    pub(super) fn new(positions: &[Position], intervals: usize) -> Self {
        let lags = LAGS.min(positions.len() / intervals).max(1);
        let zero = PairSum { within: Matrix2::zeros(), across: Matrix2::zeros() };
        let mut sums = vec![zero; lags * intervals];
        for (m, later) in positions.iter().enumerate() {
            let i = later.interval as usize;
            for lag in 1..=lags.min(m) {
                let earlier = positions[m - lag];
                let sum = &mut sums[i * lags + lag - 1];
                let target = match i - earlier.interval as usize {
                    0 => &mut sum.within,
                    1 => &mut sum.across,
                    // irregular sampling: too far apart to matter
                    _ => break,
                };
                let (x, y) = (earlier.lambda, later.lambda);
                target.m11 += (1.0 - x) * (1.0 - y);
                target.m12 += (1.0 - x) * y;
                target.m21 += x * (1.0 - y);
                target.m22 += x * y;
            }
        }
        Self { lags, sums }
    }

    /// The sums of interval i, lag 1 first.
    pub(super) fn of(&self, i: usize) -> &[PairSum] {
        &self.sums[i * self.lags..(i + 1) * self.lags]
    }
}
