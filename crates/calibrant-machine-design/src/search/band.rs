//! A symmetric positive definite matrix with a narrow band, and its Cholesky factor.
//!
//! A limit at one time depends on four neighbouring control points of all joints, so the barrier's Hessian has a band of four blocks. Its factor takes `O(size · width²)`:
//! linear in the duration.

/// The lower triangle, row by row: entry `(i, j)` with `i − width < j ≤ i`.
#[derive(Debug, Clone)]
pub(crate) struct Band {
    size: usize,
    width: usize,
    /// Row `i` at `i · width`; its diagonal is the last of the row.
    entries: Vec<f64>,
}

impl Band {
    /// All zero. `width` counts the diagonal.
    pub(crate) fn zeros(size: usize, width: usize) -> Self {
        let width = width.min(size.max(1));
        Self { size, width, entries: vec![0.0; size * width] }
    }

    pub(crate) fn clear(&mut self) {
        self.entries.fill(0.0);
    }

    #[inline(always)]
    fn place(&self, i: usize, j: usize) -> usize {
        i * self.width + (self.width - 1 + j - i)
    }

    /// Adds to entry `(i, j)` of the lower triangle.
    #[inline(always)]
    pub(crate) fn add(&mut self, i: usize, j: usize, value: f64) {
        debug_assert!(j <= i && i - j < self.width);
        let place = self.place(i, j);
        self.entries[place] += value;
    }

    /// Adds to row `i` from column `first` on.
    #[inline(always)]
    pub(crate) fn add_row(&mut self, i: usize, first: usize, values: &[f64]) {
        let place = self.place(i, first);
        for (entry, value) in self.entries[place..place + values.len()].iter_mut().zip(values) {
            *entry += value;
        }
    }

    /// Replaces it by its Cholesky factor. `false` if it is not positive definite.
    pub(crate) fn factor(&mut self) -> bool {
        let width = self.width;
        for i in 0..self.size {
            let (before, rest) = self.entries.split_at_mut(i * width);
            let row = &mut rest[..width];
            let first = (i + 1).saturating_sub(width);
            for j in first..i {
                // the columns that rows i and j share
                let start = first.max((j + 1).saturating_sub(width));
                let other = &before[j * width..(j + 1) * width];
                let (own, others) = (width - 1 + start - i, width - 1 + start - j);
                let length = j - start;
                let sum = dot(&row[own..own + length], &other[others..others + length]);
                let place = width - 1 + j - i;
                row[place] = (row[place] - sum) / other[width - 1];
            }
            let own = width - 1 + first - i;
            let square = row[width - 1] - dot(&row[own..width - 1], &row[own..width - 1]);
            if !(square > 0.0 && square.is_finite()) {
                return false;
            }
            row[width - 1] = square.sqrt();
        }
        true
    }

    /// `L⁻¹ X` in place, with the factor `L`; `x` has `columns` numbers in each row.
    pub(crate) fn solve_lower(&self, x: &mut [f64], columns: usize) {
        let width = self.width;
        for i in 0..self.size {
            let first = (i + 1).saturating_sub(width);
            let (before, rest) = x.split_at_mut(i * columns);
            let (row, before) = (&mut rest[..columns], &before[first * columns..]);
            let factors = &self.entries[(i + 1) * width - 1 - (i - first)..(i + 1) * width];
            let (diagonal, factors) = (factors[i - first], &factors[..i - first]);
            let (fours, others) = (factors.chunks_exact(4), before.chunks_exact(4 * columns));
            for (factor, other) in fours.remainder().iter().zip(others.remainder().chunks_exact(columns)) {
                for (x, other) in row.iter_mut().zip(other) {
                    *x -= factor * other;
                }
            }
            for (f, four) in fours.zip(others) {
                let ((one, two), (three, four)) =
                    (four[..2 * columns].split_at(columns), four[2 * columns..].split_at(columns));
                for ((((x, one), two), three), four) in row.iter_mut().zip(one).zip(two).zip(three).zip(four)
                {
                    *x -= (f[0] * one + f[1] * two) + (f[2] * three + f[3] * four);
                }
            }
            for x in row {
                *x /= diagonal;
            }
        }
    }

    /// `L⁻ᵀ b` in place.
    pub(crate) fn solve_upper(&self, b: &mut [f64]) {
        let width = self.width;
        for i in (0..self.size).rev() {
            let first = (i + 1).saturating_sub(width);
            let row = &self.entries[i * width..(i + 1) * width];
            let value = b[i] / row[width - 1];
            b[i] = value;
            for (b, entry) in b[first..i].iter_mut().zip(&row[width - 1 + first - i..width - 1]) {
                *b -= entry * value;
            }
        }
    }
}

/// A scalar product, in four sums that do not wait for each other.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = fours.remainder().iter().zip(others.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in fours.zip(others) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    sums[0] + sums[1] + sums[2] + sums[3] + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chains_for_tests::Numbers;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn it_solves_as_a_dense_matrix_does() {
        let (size, width) = (17, 5);
        let mut numbers = Numbers(1);
        let mut band = Band::zeros(size, width);
        let mut dense = DMatrix::zeros(size, size);
        for i in 0..size {
            for j in (i + 1).saturating_sub(width)..=i {
                let value = numbers.next(1.0) + if i == j { 9.0 } else { 0.0 };
                band.add(i, j, value);
                (dense[(i, j)], dense[(j, i)]) = (value, value);
            }
        }
        let b = DVector::from_fn(size, |_, _| numbers.next(1.0));
        assert!(band.factor());
        let mut x: Vec<f64> = b.iter().copied().collect();
        band.solve_lower(&mut x, 1);
        band.solve_upper(&mut x);
        let wanted = dense.clone().lu().solve(&b).expect("regular");
        assert!((DVector::from_vec(x) - wanted).amax() < 1e-13);
        // several columns at once
        let columns = DMatrix::from_fn(size, 3, |_, _| numbers.next(1.0));
        let mut x: Vec<f64> = columns.transpose().iter().copied().collect();
        band.solve_lower(&mut x, 3);
        let wanted = dense
            .cholesky()
            .expect("positive definite")
            .l()
            .solve_lower_triangular(&columns)
            .expect("regular");
        assert!((DMatrix::from_row_slice(size, 3, &x) - wanted).amax() < 1e-13);
    }
}
