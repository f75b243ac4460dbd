//! Legendre polynomials on −1 … 1, and polynomials in them as powers of a temperature about a reference. Powers are near singular from order 3 on; these are
//! not.

use super::{HIGHEST_ORDER, ImuParameters, SensorKind};
use nalgebra::{DMatrix, DVector};

/// `P_0(x) … P_{count−1}(x)`, by `(m + 1) P_{m+1} = (2m + 1) x P_m − m P_{m−1}`.
#[must_use]
pub fn legendre(x: f64, count: usize) -> Vec<f64> {
    let mut values = Vec::with_capacity(count);
    for k in 0..count {
        values.push(match k {
            0 => 1.0,
            1 => x,
            _ => {
                let m = (k - 1) as f64;
                ((2.0 * m + 1.0) * x * values[k - 1] - m * values[k - 2]) / (m + 1.0)
            }
        });
    }
    values
}

/// The mean of `P_m²` over the range.
#[must_use]
pub fn mean_square(m: usize) -> f64 {
    1.0 / (2.0 * m as f64 + 1.0)
}

/// The matrix `B` with `Σ c_m P_m(x) = Σ (B c)_k τ^k`, for `x` from −1 to 1 over the range and `τ = T − T₀`.
#[must_use]
pub fn powers_of_legendre(range_c: [f64; 2], reference_c: f64, count: usize) -> DMatrix<f64> {
    let [low, high] = range_c;
    let (slope, at_reference) = (2.0 / (high - low), (2.0 * reference_c - low - high) / (high - low));
    // a column of powers times x = at_reference + slope τ
    let times_x = |of: &DVector<f64>| {
        let mut product = of * at_reference;
        for k in 1..count {
            product[k] += slope * of[k - 1];
        }
        product
    };
    let mut columns: Vec<DVector<f64>> = Vec::with_capacity(count);
    for k in 0..count {
        columns.push(match k {
            0 => DVector::from_fn(count, |k, _| f64::from(u8::from(k == 0))),
            1 => times_x(&columns[0]),
            _ => {
                let m = (k - 1) as f64;
                (times_x(&columns[k - 1]) * (2.0 * m + 1.0) - &columns[k - 2] * m) / (m + 1.0)
            }
        });
    }
    DMatrix::from_columns(&columns)
}

impl ImuParameters {
    /// The same parameters with biases of at most this order: the polynomials that are nearest in the mean over the range of temperatures, which are the first
    /// terms in Legendre polynomials. Nothing changes where the range is not known.
    #[must_use]
    pub fn with_bias_order(&self, order: usize) -> Self {
        let mut shorter = *self;
        let Some(range_c) = self.thermal.range_c.filter(|[low, high]| low < high) else { return shorter };
        let powers = powers_of_legendre(range_c, self.thermal.reference_c, 1 + HIGHEST_ORDER);
        let Some(inverse) = powers.clone().try_inverse() else { return shorter };
        for sensor_kind in SensorKind::ALL {
            let (sensor, terms) = (self.sensor(sensor_kind), self.thermal.sensor(sensor_kind));
            for axis in 0..3 {
                let of = |k: usize, _| k.checked_sub(1).map_or(sensor.bias[axis], |m| terms.bias[m][axis]);
                let mut in_legendre = &inverse * DVector::from_fn(1 + HIGHEST_ORDER, of);
                in_legendre.rows_range_mut(order + 1..).fill(0.0);
                let kept = &powers * in_legendre;
                shorter[sensor_kind].bias[axis] = kept[0];
                for m in 0..HIGHEST_ORDER {
                    shorter.thermal[sensor_kind].bias[m][axis] = if m < order { kept[m + 1] } else { 0.0 };
                }
            }
        }
        shorter
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::Thermal;
    use nalgebra::Vector3;

    #[test]
    fn they_are_orthogonal_with_their_mean_square() {
        const STEPS: usize = 20_000;
        let at = |step: usize| legendre(-1.0 + (step as f64 + 0.5) * 2.0 / STEPS as f64, 6);
        let mean = |i: usize, j: usize| (0..STEPS).map(at).map(|p| p[i] * p[j]).sum::<f64>() / STEPS as f64;
        for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
            let expected = if i == j { mean_square(i) } else { 0.0 };
            assert!((mean(i, j) - expected).abs() < 1e-6, "{i} {j}: {}", mean(i, j));
        }
    }

    #[test]
    fn powers_about_a_reference_have_their_values() {
        let powers = powers_of_legendre([-20.0, 60.0], 25.0, 6);
        let c = DVector::from_fn(6, |m, _| 1.0 - 0.3 * m as f64);
        let of_tau = &powers * &c;
        for celsius in [-20.0, 3.5, 25.0, 60.0] {
            let (x, tau) = ((2.0 * celsius - 40.0) / 80.0, celsius - 25.0_f64);
            let expected: f64 = legendre(x, 6).iter().zip(c.iter()).map(|(p, c)| p * c).sum();
            let found: f64 = (0..6).map(|k| of_tau[k] * tau.powi(k as i32)).sum();
            assert!((found - expected).abs() < 1e-12, "{celsius}: {found} {expected}");
        }
    }

    /// `P_4 = (35 x⁴ − 30 x² + 3)/8` has no part of order 3.
    #[test]
    fn a_fourth_legendre_polynomial_leaves_nothing_of_order_3() {
        let mut parameters = ImuParameters::identity();
        parameters.thermal = Thermal { reference_c: 10.0, range_c: Some([0.0, 20.0]), ..Thermal::none() };
        let (of, axis) = (SensorKind::Gyroscope, Vector3::new(0.0, 1.0, 0.0));
        parameters[of].bias = axis * (1.0 + 3.0 / 8.0);
        parameters.thermal[of].bias[1] = axis * (-30.0 / 8.0 / 100.0);
        parameters.thermal[of].bias[3] = axis * (35.0 / 8.0 / 1e4);
        let shorter = parameters.with_bias_order(3);
        assert!((shorter[of].bias - axis).norm() < 1e-12);
        assert!(shorter.thermal[of].bias.iter().all(|of| of.norm() < 1e-13), "{:?}", shorter.thermal[of]);
        assert_eq!(parameters.with_bias_order(4).thermal[of].order(crate::sensor::ThermalPart::Bias), 4);
    }
}
