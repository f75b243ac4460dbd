//! The times of a recording's samples on a motion, and the sums over them that the information needs.

use super::JerkControlledMotion;

/// Sample times `t_j = j/f_s` from the start of a motion to its end, both included: `M = T f_s + 1`.
#[must_use]
pub fn sample_times(motion: &JerkControlledMotion, rate_hz: f64) -> Vec<f64> {
    let start = motion.times_s()[0];
    let duration = motion.times_s()[motion.intervals()] - start;
    let last = (duration * rate_hz * (1.0 + 1e-12)).floor() as usize;
    (0..=last).map(|j| start + j as f64 / rate_hz).collect()
}

/// Sums over the samples of one interval of their place λ in it, 0 to 1. The information of a recording
/// depends on its samples only through these sums.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct IntervalSums {
    /// Number of samples.
    pub samples: f64,
    /// `Σ (1 − λ)`
    pub s0: f64,
    /// `Σ λ`
    pub s1: f64,
    /// `Σ (1 − λ)²`
    pub m00: f64,
    /// `Σ λ (1 − λ)`
    pub m01: f64,
    /// `Σ λ²`
    pub m11: f64,
}

impl IntervalSums {
    /// The sums of each interval, for samples at `rate_hz` from the start of the motion to its end. A sample at a breakpoint belongs to the interval that
    /// begins there.
    #[must_use]
    pub fn all(motion: &JerkControlledMotion, rate_hz: f64) -> Vec<Self> {
        let mut sums = vec![Self::default(); motion.intervals()];
        for t in sample_times(motion, rate_hz) {
            let (i, lambda) = motion.locate(t);
            let (sum, rest) = (&mut sums[i], 1.0 - lambda);
            sum.samples += 1.0;
            sum.s0 += rest;
            sum.s1 += lambda;
            sum.m00 += rest * rest;
            sum.m01 += rest * lambda;
            sum.m11 += lambda * lambda;
        }
        sums
    }
}
