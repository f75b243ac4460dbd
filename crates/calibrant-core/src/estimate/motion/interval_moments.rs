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
#[derive(Debug, Clone)]
pub(super) struct Positions {
    /// First sample of each interval, and one past the last sample of all.
    starts: Vec<usize>,
    /// Place of each sample within its interval, 0 to 1.
    pub(super) lambda: Vec<f64>,
}

impl Positions {
    /// Locates samples on breakpoints `tau` in one pass; both ascend. Times outside are clamped to the ends.
    pub(super) fn locate(times: &[f64], tau: &[f64]) -> Self {
        let intervals = tau.len() - 1;
        let mut starts = Vec::with_capacity(intervals + 1);
        let mut lambda = Vec::with_capacity(times.len());
        for i in 0..intervals {
            starts.push(lambda.len());
            let duration = tau[i + 1] - tau[i];
            let place = |t: f64| ((t - tau[i]) / duration).clamp(0.0, 1.0);
            let rest = &times[lambda.len()..];
            if i + 1 == intervals {
                lambda.extend(rest.iter().map(|&t| place(t)));
            } else {
                lambda.extend(rest.iter().take_while(|&&t| t < tau[i + 1]).map(|&t| place(t)));
            }
        }
        starts.push(lambda.len());
        Self { starts, lambda }
    }

    /// Number of intervals.
    pub(super) fn intervals(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of samples.
    pub(super) fn samples(&self) -> usize {
        self.lambda.len()
    }

    /// The samples of interval i.
    pub(super) fn interval_samples(&self, i: usize) -> std::ops::Range<usize> {
        self.starts[i]..self.starts[i + 1]
    }
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
    positions: &Positions,
    readings: &[Vector3<f64>],
    z: &[Vector3<f64>],
    axes: [usize; D],
) -> Vec<Moments<D>> {
    let zero = SVector::zeros();
    (0..positions.intervals())
        .map(|i| {
            let samples = positions.interval_samples(i);
            let mut m = Moments {
                m00: 0.0,
                m01: 0.0,
                m11: 0.0,
                e0: zero,
                e1: zero,
                e2: zero,
                samples: samples.len(),
            };
            let (z0, z1) = (axes.map(|axis| z[i][axis]), axes.map(|axis| z[i + 1][axis]));
            for (&w1, reading) in positions.lambda[samples.clone()].iter().zip(&readings[samples]) {
                let w0 = 1.0 - w1;
                m.m00 += w0 * w0;
                m.m01 += w0 * w1;
                m.m11 += w1 * w1;
                for k in 0..D {
                    let e = reading[axes[k]] - (w0 * z0[k] + w1 * z1[k]);
                    m.e0[k] += w0 * e;
                    m.e1[k] += w1 * e;
                    m.e2[k] += e * e;
                }
            }
            m
        })
        .collect()
}
