//! The discrete Fourier transform of real values. Its library is generic and large: who used it directly would compile it again.

use nalgebra::Complex;
use realfft::{RealFftPlanner, RealToComplex};
use std::fmt;
use std::sync::Arc;

/// `Σ y_j e^{−2πi jk/n}` for `k = 0 … n/2`. The plan does not depend on the values and is made once.
#[derive(Clone)]
pub struct Fourier(Arc<dyn RealToComplex<f64>>);

impl fmt::Debug for Fourier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Fourier({})", self.size())
    }
}

impl Fourier {
    /// The plan for this number of values.
    #[must_use]
    pub fn of_size(size: usize) -> Self {
        Self(RealFftPlanner::new().plan_fft_forward(size))
    }

    /// `n`.
    #[must_use]
    pub fn size(&self) -> usize {
        self.0.len()
    }

    /// The transform of values, which zeros extend to `n`.
    #[must_use]
    pub fn transform(&self, values: impl IntoIterator<Item = f64>) -> Vec<Complex<f64>> {
        let mut padded = self.0.make_input_vec();
        padded.iter_mut().zip(values).for_each(|(place, value)| *place = value);
        let mut spectrum = self.0.make_output_vec();
        // the lengths are those of the plan: it cannot fail
        let _ = self.0.process(&mut padded, &mut spectrum);
        spectrum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn it_is_the_sum() {
        let values: Vec<f64> = (0..50).map(|k| f64::from(k * k % 17)).collect();
        for size in [50, 64] {
            let spectrum = Fourier::of_size(size).transform(values.iter().copied());
            assert_eq!(spectrum.len(), size / 2 + 1);
            for (k, found) in spectrum.into_iter().enumerate() {
                let part = |(j, y): (usize, &f64)| Complex::cis(-TAU * (j * k) as f64 / size as f64) * *y;
                let expected: Complex<f64> = values.iter().enumerate().map(part).sum();
                assert!((found - expected).norm() < 1e-9, "{size} {k}: {found} {expected}");
            }
        }
    }
}
