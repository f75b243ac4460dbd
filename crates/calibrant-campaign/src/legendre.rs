//! Legendre polynomials on −1 … 1. Powers of a temperature are near singular from order 3 on; these are not.

/// `P_0(x) … P_{count−1}(x)`, by `(m + 1) P_{m+1} = (2m + 1) x P_m − m P_{m−1}`.
pub(crate) fn legendre(x: f64, count: usize) -> Vec<f64> {
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
pub(crate) fn mean_square(m: usize) -> f64 {
    1.0 / (2.0 * m as f64 + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
