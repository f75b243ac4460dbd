//! Steps from one value to the next: how large they are, and the tails of the noise.
//!
//! Heavy tails of the noise widen the interval of N, which assumes Gaussian noise otherwise.
//! For independent samples of excess kurtosis κ every Allan variance varies more by the same term,
//! `var(N̂²)/N⁴` by `κ/n`. Each sample has the weight `1/(m n)` in the variance at `m`, which is `N²/m`.
//! Differences of successive samples have half of κ, and little of slow noise.

use super::{Coefficient, Estimate};

/// Standard deviation of normal noise over the median of its absolute deviations.
const MAD: f64 = 1.4826;
/// Below this excess kurtosis nothing is changed. Gaussian noise of a few thousand samples does not reach it.
const HEAVY: f64 = 0.5;
/// Samples far off make most of the noise from this ratio on: standard deviation of differences over their
/// robust one. Student's t of three degrees of freedom has 1.4.
const FAR_OFF: f64 = 1.6;
/// From this step on, in standard deviations, the quantisation makes a median jump.
const COARSE: f64 = 0.3;
/// Half a 95 % interval in standard deviations.
const HALF_INTERVAL: f64 = 1.96;

/// The differences of successive values.
pub(super) struct Steps {
    samples: usize,
    /// Their robust standard deviation.
    pub(super) typical: f64,
    /// The smallest that is not zero; infinite where all are zero.
    pub(super) finest: f64,
    /// Their mean square.
    second: f64,
    /// Their mean fourth power.
    fourth: f64,
}

impl Steps {
    pub(super) fn of(values: &[f64]) -> Self {
        let sizes = sizes(values, 1);
        let count = sizes.len() as f64;
        let (mut second, mut fourth, mut finest) = (0.0, 0.0, f64::INFINITY);
        for size in &sizes {
            let square = size * size;
            second += square;
            fourth += square * square;
            finest = if *size > 0.0 { finest.min(*size) } else { finest };
        }
        Self {
            samples: values.len(),
            typical: robust(sizes),
            finest,
            second: second / count,
            fourth: fourth / count,
        }
    }

    /// Do a few samples far off make most of the noise?
    pub(super) fn reach_far(&self) -> bool {
        self.finest < COARSE * self.typical && self.second.sqrt() / self.typical > FAR_OFF
    }

    /// The density of white noise with the uncertainty that these tails give it.
    pub(super) fn widen(&self, density: Coefficient) -> Coefficient {
        // of the samples
        let excess = 2.0 * (self.fourth / (self.second * self.second) - 3.0);
        match density {
            Coefficient::Determined(found) if excess > HEAVY => {
                let sd = 0.5 * found.value * (excess / self.samples as f64).sqrt();
                let half = |half: f64| half.hypot(HALF_INTERVAL * sd);
                Coefficient::Determined(Estimate {
                    value: found.value,
                    sd: found.sd.hypot(sd),
                    low: (found.value - half(found.value - found.low)).max(0.0),
                    high: found.value + half(found.high - found.value),
                })
            }
            other => other,
        }
    }
}

/// Robust standard deviation of the difference of values at this distance.
pub(super) fn typical_step(values: &[f64], apart: usize) -> f64 {
    robust(sizes(values, apart))
}

fn sizes(values: &[f64], apart: usize) -> Vec<f64> {
    values.iter().zip(values.iter().skip(apart)).map(|(one, other)| (other - one).abs()).collect()
}

/// Robust standard deviation of differences of these sizes.
fn robust(mut sizes: Vec<f64>) -> f64 {
    let middle = sizes.len() / 2;
    if sizes.is_empty() { 0.0 } else { MAD * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
