//! Knots at half the distance, exactly.
//!
//! A uniform cubic B-spline is a sum of five of half the width with weights `(1, 4, 6, 4, 1)/8` (`deboor2001`). So the same motion on the finer knots has control
//! points `(c_i + c_{i+1})/2` and `(c_{i−1} + 6 c_i + c_{i+1})/8` in turn.

use nalgebra::DMatrix;

/// The control points of the same motion on knots at half the distance.
pub(crate) fn halved(controls: &DMatrix<f64>) -> DMatrix<f64> {
    let number = controls.nrows();
    DMatrix::from_fn(2 * number - 3, controls.ncols(), |i, j| {
        let c = |k: usize| controls[(k, j)];
        let k = i / 2;
        if i % 2 == 0 { (c(k) + c(k + 1)) / 2.0 } else { (c(k) + 6.0 * c(k + 1) + c(k + 2)) / 8.0 }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chains_for_tests::Numbers;
    use crate::motion::Knots;

    #[test]
    fn the_motion_stays_the_same() {
        let mut numbers = Numbers(3);
        let knots = Knots { step_s: 0.8, intervals: 7 };
        let controls = DMatrix::from_fn(knots.controls(), 2, |_, _| numbers.next(2.0));
        let fine = knots.halved();
        let [coarse, fine] = [knots.spline(&controls), fine.spline(&halved(&controls))];
        for k in 0..=50 {
            let t = 5.6 * f64::from(k) / 50.0;
            for d in 0..3 {
                for (a, b) in coarse.at(t, d).iter().zip(fine.at(t, d)) {
                    assert!((a - b).abs() < 1e-12, "{t} {d}: {a} {b}");
                }
            }
        }
    }
}
