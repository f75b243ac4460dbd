//! Gauss–Legendre points: an integral over an interval from a few places.
//!
//! `m` points integrate polynomials up to degree `2m − 1`. Between knots a motion is smooth, so 3 to 5 points in an interval replace hundreds of samples.

/// Places in `[0, 1]` and weights, whose sum is 1.
///
/// The places are the zeros of the Legendre polynomial `P_m`, found by Newton's method from `cos(π (k − ¼)/(m + ½))`; a weight is
/// `2/((1 − x²) P_m′(x)²)` on `[−1, 1]`.
pub(crate) fn gauss_legendre(points: usize) -> Vec<(f64, f64)> {
    let m = points as f64;
    let polynomial = |x: f64| {
        let (mut before, mut here) = (1.0, x);
        for k in 2..=points {
            let k = k as f64;
            (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
        }
        (here, m * (x * here - before) / (x * x - 1.0))
    };
    let one = |k: usize| {
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (m + 0.5)).cos();
        for _ in 0..50 {
            let (value, slope) = polynomial(x);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        let slope = polynomial(x).1;
        ((1.0 - x) / 2.0, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..points).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for points in 2..7 {
            for degree in 0..2 * points {
                let sum: f64 = gauss_legendre(points).iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
                assert!((sum - 1.0 / (degree as f64 + 1.0)).abs() < 1e-14, "{points} {degree} {sum}");
            }
        }
    }
}
