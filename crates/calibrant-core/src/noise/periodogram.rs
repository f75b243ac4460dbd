//! The periodogram: the power of values at each frequency.

use realfft::{RealFftPlanner, RealToComplex};
use std::fmt;
use std::sync::Arc;

/// `|Σ y e^{−2πi jk/n}|²` for `k = 0 … n/2`, of values that zeros extend to `n`, a power of two. The plan
/// does not depend on the values and is made once.
#[derive(Clone)]
pub(super) struct Periodogram(Arc<dyn RealToComplex<f64>>);

impl fmt::Debug for Periodogram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Periodogram({})", self.size())
    }
}

impl Periodogram {
    /// The plan for this number of values.
    pub(super) fn of_length(count: usize) -> Self {
        Self(RealFftPlanner::new().plan_fft_forward(count.next_power_of_two()))
    }

    /// `n`.
    pub(super) fn size(&self) -> usize {
        self.0.len()
    }

    /// The power of these values, at most `n`.
    pub(super) fn power(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let (mut padded, mut spectrum) = (self.0.make_input_vec(), self.0.make_output_vec());
        padded.iter_mut().zip(values).for_each(|(place, value)| *place = value);
        // the lengths are those of the plan: it cannot fail
        let _ = self.0.process(&mut padded, &mut spectrum);
        spectrum.iter().map(|sum| sum.norm_sqr()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn it_is_that_of_the_sum() {
        let values: Vec<f64> = (0..50).map(|k| f64::from(k * k % 17)).collect();
        let periodogram = Periodogram::of_length(50);
        assert_eq!(periodogram.size(), 64);
        for (k, power) in periodogram.power(values.iter().copied()).into_iter().enumerate() {
            let part = |of: fn(f64) -> f64| -> f64 {
                values.iter().enumerate().map(|(j, y)| y * of(TAU * (j * k) as f64 / 64.0)).sum()
            };
            let expected = part(f64::cos).powi(2) + part(f64::sin).powi(2);
            assert!((power - expected).abs() < 1e-7 * (1.0 + expected), "{k}: {power} {expected}");
        }
    }
}
