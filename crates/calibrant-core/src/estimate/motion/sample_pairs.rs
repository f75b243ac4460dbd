//! Sums over pairs of nearby samples, which the whiteness test needs.
//!
//! Residuals of a fit are correlated even for white noise: their covariance is `σ² (I − P)` with the hat matrix `P`. The fit reduces the l-th
//! autocovariance by the off-diagonal sum `c_l = Σ_k P_{k,k+l}`. `P_{k,m}` is the covariance of the fitted readings at two samples, and bilinear in
//! their places `λ`. So c_l needs only these sums for each interval, once for all axes.

use super::interval_moments::Positions;
use super::whiteness::dot;
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
    /// Number of lags L: 10, or the samples of an interval if fewer. No pair then spans more than two intervals.
    pub(super) lags: usize,
    sums: Vec<PairSum>,
}

impl PairSums {
    pub(super) fn new(positions: &Positions) -> Self {
        let lambda = &positions.lambda;
        let mut running = Vec::with_capacity(lambda.len() + 1);
        let mut total = 0.0;
        running.push(total);
        running.extend(lambda.iter().map(|l| {
            total += l;
            total
        }));
        // pairs (k, k + lag) for k in from..to
        let sum = |from: usize, to: usize, lag: usize| {
            if to <= from {
                return Matrix2::zeros();
            }
            let (x, y) = (running[to] - running[from], running[to + lag] - running[from + lag]);
            let xy = dot(&lambda[from..to], &lambda[from + lag..to + lag]);
            Matrix2::new((to - from) as f64 - x - y + xy, y - xy, x - xy, xy)
        };
        let lags = LAGS.min(positions.samples() / positions.intervals()).max(1);
        let mut sums = Vec::with_capacity(lags * positions.intervals());
        let mut before = 0;
        for i in 0..positions.intervals() {
            let own = positions.interval_samples(i);
            for lag in 1..=lags {
                let first = own.start.saturating_sub(lag).max(before);
                sums.push(PairSum {
                    within: sum(own.start, own.end.saturating_sub(lag), lag),
                    // irregular sampling may make pairs that span a whole interval: too far apart to matter
                    across: sum(first, own.start.min(own.end.saturating_sub(lag)), lag),
                });
            }
            before = own.start;
        }
        Self { lags, sums }
    }

    /// The sums of interval i, lag 1 first.
    pub(super) fn interval(&self, i: usize) -> &[PairSum] {
        &self.sums[i * self.lags..(i + 1) * self.lags]
    }
}
