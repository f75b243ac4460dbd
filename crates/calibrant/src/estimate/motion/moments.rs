//! What the samples of each interval say, in a dozen numbers.
//!
//! The model's reading is linear between nodes, `h(λ) = (1 − λ) h_0 + λ h_1`, whatever the parameters: so the samples enter the
//! cost only through sums over λ. One pass over the M samples makes the rest of the work independent of M.
//!
//! The sums are taken of `e = y − [(1 − λ) z_0 + λ z_1]`, the reading less a reference `z` close to it, because sums of `y²` would lose
//! the digits of the noise.

use nalgebra::{SVector, Vector3};

/// Sums over the samples of one interval.
#[derive(Debug, Clone)]
pub(super) struct Moments<const D: usize> {
    /// `Σ (1 − λ)²`
    pub(super) m00: f64,
    /// `Σ λ (1 − λ)`
    pub(super) m01: f64,
    /// `Σ λ²`
    pub(super) m11: f64,
    /// `Σ (1 − λ) e`
    pub(super) e0: SVector<f64, D>,
    /// `Σ λ e`
    pub(super) e1: SVector<f64, D>,
    /// `Σ e²`, per axis
    pub(super) e2: SVector<f64, D>,
    /// Number of samples.
    pub(super) samples: usize,
}

/// Where the samples lie on the chain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Position {
    /// Interval.
    pub(super) interval: u32,
    /// Place within it, 0 to 1.
    pub(super) lambda: f64,
}

/// Locates samples on breakpoints `tau` in one pass; both ascend. Times outside are clamped to the ends.
pub(super) fn locate(times: &[f64], tau: &[f64]) -> Vec<Position> {
    let last = tau.len() - 2;
    let mut i = 0;
    times
        .iter()
        .map(|&t| {
            while i < last && t >= tau[i + 1] {
                i += 1;
            }
            Position { interval: i as u32, lambda: ((t - tau[i]) / (tau[i + 1] - tau[i])).clamp(0.0, 1.0) }
        })
        .collect()
}

/// The reading nearest in time to each breakpoint: the reference `z`.
pub(super) fn reference(times: &[f64], readings: &[Vector3<f64>], tau: &[f64]) -> Vec<Vector3<f64>> {
    tau.iter()
        .map(|&t| {
            let after = times.partition_point(|&time| time < t).min(times.len() - 1);
            let before = after.saturating_sub(1);
            readings[if (times[before] - t).abs() < (times[after] - t).abs() { before } else { after }]
        })
        .collect()
}

/// The moments of the axes `axes` about the reference readings `z`.
pub(super) fn moments<const D: usize>(
    positions: &[Position],
    readings: &[Vector3<f64>],
    z: &[Vector3<f64>],
    axes: [usize; D],
) -> Vec<Moments<D>> {
    let zero = SVector::zeros();
    let mut moments =
        vec![Moments { m00: 0.0, m01: 0.0, m11: 0.0, e0: zero, e1: zero, e2: zero, samples: 0 }; z.len() - 1];
    for (position, reading) in positions.iter().zip(readings) {
        let i = position.interval as usize;
        let (w0, w1) = (1.0 - position.lambda, position.lambda);
        let m = &mut moments[i];
        m.m00 += w0 * w0;
        m.m01 += w0 * w1;
        m.m11 += w1 * w1;
        m.samples += 1;
        for (k, &axis) in axes.iter().enumerate() {
            let e = reading[axis] - (w0 * z[i][axis] + w1 * z[i + 1][axis]);
            m.e0[k] += w0 * e;
            m.e1[k] += w1 * e;
            m.e2[k] += e * e;
        }
    }
    moments
}
