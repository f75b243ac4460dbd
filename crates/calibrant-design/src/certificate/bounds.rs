//! Closed-form bounds that no admissible motion can exceed. They scale every unknown of the relaxation, and
//! are a bound of their own.

use super::AxisChain;
use calibrant_core::motion::Rest;

/// Bounds on the sizes of node accelerations and of the chain's states at the nodes; infinite where there is none.
#[derive(Debug, Clone)]
pub(super) struct StateBounds {
    /// Acceleration, m/s².
    pub(super) a: Vec<f64>,
    /// Velocity, m/s.
    pub(super) v: Vec<f64>,
    /// Displacement, m.
    pub(super) d: Vec<f64>,
    /// Sum of the samples before the node, m/s².
    pub(super) sum: Vec<f64>,
}

impl StateBounds {
    /// Propagates the limits along the chain and back.
    ///
    /// Limits that hold for all t bound derivatives inside an interval too, by Markov's inequality. For
    /// polynomials of degree n on an interval of length Δτ, `|p'| ≤ 2n² max|p|/Δτ` and
    /// `|p''| ≤ 4n²(n² − 1) max|p|/(3 Δτ²)`. So `|α| ≤ 8 v_max/Δτ`, `|α| ≤ 96 d_max/Δτ²`,
    /// `|v| ≤ 18 d_max/Δτ`.
    pub(super) fn of(chain: &AxisChain) -> Self {
        let (n, dt, l) = (chain.sums.len(), chain.interval_s, &chain.limits);
        let unlimited = f64::INFINITY;
        let acceleration = l.acceleration.unwrap_or(unlimited);
        let velocity = l.velocity.unwrap_or(unlimited);
        let displacement = l.displacement.unwrap_or(unlimited);
        let step = l.jerk.unwrap_or(unlimited) * dt;
        let markov = (8.0 * velocity / dt).min(96.0 * displacement / (dt * dt));
        let mut a = vec![acceleration.min(markov); n + 1];
        if let (Some(x), Some(u)) = (l.intercept, l.jerk) {
            // a node is on the lines of both its intervals
            a.iter_mut().enumerate().for_each(|(i, a)| *a = a.min(x + u * i as f64 * dt));
        }
        if let Some(x) = l.intercept {
            a[0] = a[0].min(x);
        }
        for (node, value) in [(0, l.start), (n, l.end)] {
            if let Some(value) = value {
                a[node] = a[node].min(value.abs());
            }
        }
        for i in 0..n {
            a[i + 1] = a[i + 1].min(a[i] + step);
        }
        for i in (0..n).rev() {
            a[i] = a[i].min(a[i + 1] + step);
        }

        let (mut v, mut d, mut sum) = (vec![0.0; n + 1], vec![0.0; n + 1], vec![0.0; n + 1]);
        for i in 0..n {
            let gain = (a[i] + a[i + 1]) * dt / 2.0;
            v[i + 1] = velocity.min(18.0 * displacement / dt).min(v[i] + gain);
            let bend = (2.0 * a[i] + a[i + 1]) * dt * dt / 6.0;
            d[i + 1] = displacement.min(d[i] + v[i] * dt + bend);
            sum[i + 1] = sum[i] + chain.sums[i].s0 * a[i] + chain.sums[i].s1 * a[i + 1];
        }
        if l.rest == Rest::Both {
            v[n] = 0.0;
            for i in (0..n).rev() {
                v[i] = v[i].min(v[i + 1] + (a[i] + a[i + 1]) * dt / 2.0);
            }
        }
        Self { a, v, d, sum }
    }

    /// The same bound at every node: the largest.
    pub(super) fn everywhere(&self) -> Self {
        let flat = |bounds: &[f64]| vec![bounds.iter().copied().fold(0.0, f64::max); bounds.len()];
        Self { a: flat(&self.a), v: flat(&self.v), d: flat(&self.d), sum: flat(&self.sum) }
    }

    /// Sum of the largest `Σ α²` of each interval in `range`, each node at its bound.
    pub(super) fn sum_of_squares(&self, chain: &AxisChain, range: std::ops::Range<usize>) -> f64 {
        range
            .map(|i| {
                let (m, a, b) = (&chain.sums[i], self.a[i], self.a[i + 1]);
                m.m00 * a * a + 2.0 * m.m01 * a * b + m.m11 * b * b
            })
            .sum::<f64>()
            * (1.0 + 1e-12)
    }
}
