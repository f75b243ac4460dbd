//! A symmetric positive definite band matrix, its Cholesky factor, and the band of its inverse.

/// Lower band of a symmetric matrix: row `i` has the entries of columns `i − width + 1 … i`.
#[derive(Debug, Clone)]
pub(super) struct Band {
    width: usize,
    rows: Vec<f64>,
}

impl Band {
    pub(super) fn zeros(size: usize, width: usize) -> Self {
        Self { width, rows: vec![0.0; size * width] }
    }

    pub(super) fn size(&self) -> usize {
        self.rows.len() / self.width
    }

    fn place(&self, i: usize, j: usize) -> usize {
        i * self.width + (self.width - 1 + j - i)
    }

    /// Entry (i, j) with `i − width < j ≤ i`.
    pub(super) fn get(&self, i: usize, j: usize) -> f64 {
        self.rows[self.place(i, j)]
    }

    pub(super) fn add(&mut self, i: usize, j: usize, value: f64) {
        let place = self.place(i, j);
        self.rows[place] += value;
    }

    fn first(&self, i: usize) -> usize {
        (i + 1).saturating_sub(self.width)
    }

    /// The Cholesky factor `L`, `A = L Lᵀ`. A pivot that vanishes by rounding becomes one that fixes its unknown.
    pub(super) fn cholesky(mut self) -> Self {
        for i in 0..self.size() {
            for j in self.first(i)..=i {
                let begin = self.first(i).max(self.first(j));
                let sum: f64 = (begin..j).map(|k| self.get(i, k) * self.get(j, k)).sum();
                let place = self.place(i, j);
                let rest = self.rows[place] - sum;
                self.rows[place] = if i == j {
                    if rest > 1e-14 * self.rows[place].abs() { rest.sqrt() } else { f64::INFINITY }
                } else {
                    rest / self.get(j, j)
                };
            }
        }
        self
    }

    /// Solves `L Lᵀ x = b` in place, with this as `L`.
    pub(super) fn solve(&self, b: &mut [f64]) {
        for i in 0..b.len() {
            let sum: f64 = (self.first(i)..i).map(|k| self.get(i, k) * b[k]).sum();
            b[i] = (b[i] - sum) / self.get(i, i);
        }
        for i in (0..b.len()).rev() {
            b[i] /= self.get(i, i);
            for k in self.first(i)..i {
                b[k] -= self.get(i, k) * b[i];
            }
        }
    }

    /// The band of `(L Lᵀ)⁻¹`, with this as `L` (`takahashi1973`).
    pub(super) fn inverse_band(&self) -> Self {
        let size = self.size();
        let mut inverse = Self::zeros(size, self.width);
        for j in (0..size).rev() {
            let last = (j + self.width).min(size);
            for i in (j..last).rev() {
                let symmetric = |inverse: &Self, a: usize, b: usize| inverse.get(a.max(b), a.min(b));
                let sum: f64 = (j + 1..last).map(|k| self.get(k, j) * symmetric(&inverse, i, k)).sum();
                let own = if i == j { 1.0 / self.get(j, j) } else { 0.0 };
                inverse.add(i, j, (own - sum) / self.get(j, j));
            }
        }
        inverse
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn it_equals_dense_algebra() {
        let (size, width) = (9, 4);
        let mut band = Band::zeros(size, width);
        for i in 0..size {
            for j in (i + 1_usize).saturating_sub(width)..=i {
                band.add(i, j, if i == j { 5.0 } else { ((3 * i + 7 * j) as f64).sin() });
            }
        }
        let near = |i: usize, j: usize| i.abs_diff(j) < width;
        let dense =
            DMatrix::from_fn(size, size, |i, j| if near(i, j) { band.get(i.max(j), i.min(j)) } else { 0.0 });
        let b = DVector::from_fn(size, |i, _| i as f64 - 3.0);
        let factor = band.cholesky();
        let mut x = b.as_slice().to_vec();
        factor.solve(&mut x);
        let inverse = dense.try_inverse().expect("it is diagonally dominant");
        assert!((&inverse * b - DVector::from_vec(x)).norm() < 1e-13);
        let of_band = factor.inverse_band();
        for i in 0..size {
            for j in (0..=i).filter(|j| near(i, *j)) {
                assert!((inverse[(i, j)] - of_band.get(i, j)).abs() < 1e-13);
            }
        }
    }
}
