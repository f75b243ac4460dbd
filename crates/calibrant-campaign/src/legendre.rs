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
        let mut sums = [[0.0; 6]; 6];
        for step in 0..STEPS {
            let p = legendre(-1.0 + (step as f64 + 0.5) * 2.0 / STEPS as f64, 6);
            for i in 0..6 {
                for j in 0..6 {
                    sums[i][j] += p[i] * p[j] / STEPS as f64;
                }
            }
        }
        for i in 0..6 {
            for j in 0..6 {
                let expected = if i == j { mean_square(i) } else { 0.0 };
                assert!((sums[i][j] - expected).abs() < 1e-6, "{i} {j}: {}", sums[i][j]);
            }
        }
    }
}
