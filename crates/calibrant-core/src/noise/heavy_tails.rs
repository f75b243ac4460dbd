//! Heavy tails of the noise. They widen the interval of N, which assumes Gaussian noise otherwise.
//!
//! For independent samples of excess kurtosis κ every Allan variance varies more by the same term,
//! `var(N̂²)/N⁴` by `κ/n`. Each sample has the weight `1/(m n)` in the variance at `m`, which is `N²/m`.
//! Differences of successive samples have half of κ, and little of slow noise.

use super::outliers::typical_step;
use super::{Coefficient, Estimate};

/// Below this excess kurtosis nothing is changed. Gaussian noise of a few thousand samples does not reach it.
const HEAVY: f64 = 0.5;
/// Samples far off make most of the noise from this ratio on: standard deviation of differences over their
/// robust one. Student's t of three degrees of freedom has 1.4.
const FAR_OFF: f64 = 1.6;
/// From this step on, in standard deviations, the quantisation makes a median jump.
const COARSE: f64 = 0.3;
/// Half a 95 % interval in standard deviations.
const HALF_INTERVAL: f64 = 1.96;

/// The tails of some values.
pub(super) struct Tails {
    samples: usize,
    /// Excess kurtosis of the samples, from their differences.
    excess: f64,
    /// Standard deviation of differences over their robust one.
    reach: f64,
}

impl Tails {
    /// The tails of values at equal intervals, at least two of them different.
    pub(super) fn of(values: &[f64]) -> Self {
        let sizes: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
        let count = sizes.len() as f64;
        let moment = |power: i32| sizes.iter().map(|size| size.powi(power)).sum::<f64>() / count;
        let (second, fourth) = (moment(2), moment(4));
        let finest = sizes.iter().copied().filter(|size| *size > 0.0).fold(f64::INFINITY, f64::min);
        let robust = typical_step(values, 1);
        let reach = if finest < COARSE * robust { second.sqrt() / robust } else { 1.0 };
        Self { samples: values.len(), excess: 2.0 * (fourth / (second * second) - 3.0), reach }
    }

    /// Do a few samples far off make most of the noise?
    pub(super) fn reach_far(&self) -> bool {
        self.reach > FAR_OFF
    }

    /// The density of white noise with the uncertainty that these tails give it.
    pub(super) fn widen(&self, density: Coefficient) -> Coefficient {
        match density {
            Coefficient::Determined(found) if self.excess > HEAVY => {
                let sd = 0.5 * found.value * (self.excess / self.samples as f64).sqrt();
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
