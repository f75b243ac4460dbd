//! Sums of squares of rows, four rows at a time: each entry of the sum is read and written once for four of them.

/// Adds `Σ w_k g_k g_kᵀ` to the lower triangle of `out`, row by row. `rows` has the `g_k` one after the other, each of this width.
pub(crate) fn add_squares(rows: &[f64], width: usize, weight: impl Fn(usize) -> f64, out: &mut [f64]) {
    let mut fours = rows.chunks_exact(4 * width);
    let mut first = 0;
    for four in &mut fours {
        let ([one, two], [three, four]) =
            ([&four[..width], &four[width..2 * width]], [&four[2 * width..3 * width], &four[3 * width..]]);
        let [f, g, h, i] = [weight(first), weight(first + 1), weight(first + 2), weight(first + 3)];
        for a in 0..width {
            let (f, g, h, i) = (f * one[a], g * two[a], h * three[a], i * four[a]);
            let sums = out[a * width..=a * width + a].iter_mut();
            for ((((sum, one), two), three), four) in sums.zip(one).zip(two).zip(three).zip(four) {
                *sum += (f * one + g * two) + (h * three + i * four);
            }
        }
        first += 4;
    }
    for (k, row) in fours.remainder().chunks_exact(width).enumerate() {
        let weight = weight(first + k);
        for a in 0..width {
            let factor = weight * row[a];
            for (sum, other) in out[a * width..=a * width + a].iter_mut().zip(row) {
                *sum += factor * other;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chains_for_tests::Numbers;
    use nalgebra::DMatrix;

    #[test]
    fn the_sum_is_that_of_products() {
        let mut numbers = Numbers(4);
        let (width, number) = (5, 11);
        let rows: Vec<f64> = (0..width * number).map(|_| numbers.next(1.0)).collect();
        let weights: Vec<f64> = (0..number).map(|_| numbers.next(1.0)).collect();
        let mut found = vec![0.0; width * width];
        add_squares(&rows, width, |k| weights[k], &mut found);
        let all = DMatrix::from_row_slice(number, width, &rows);
        let weighted = DMatrix::from_fn(number, width, |i, j| weights[i] * all[(i, j)]);
        let wanted = all.tr_mul(&weighted);
        for a in 0..width {
            for b in 0..=a {
                assert!((found[a * width + b] - wanted[(a, b)]).abs() < 1e-14, "{a} {b}");
            }
        }
    }
}
