//! Errors in units of what is predicted of each alone, and what they have in common through the parameters.
//!
//! With `C = D + J Σ Jᵀ`, `Σ = R Rᵀ` and `D = L Lᵀ`: `z = L⁻¹ e`, `K = L⁻¹ J R`, and
//!
//! ```text
//! eᵀ C⁻¹ e = zᵀ z − (Kᵀ z)ᵀ (I + Kᵀ K)⁻¹ Kᵀ z
//! ```
//!
//! (Woodbury), so that nothing has the size of all errors squared. `D` is block diagonal but for what neighbours share: with `B_i` the covariance of the errors of item i with
//! those of the one before, the blocks of `L` are `G_i = B_i L_{i−1}⁻ᵀ` and the root `L_i` of `D_i − G_i G_iᵀ`. The root of `Σ` is that of its eigenvalues: it may be singular.

use super::predicted_error::{Group, Item};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// The errors of a group that count, whitened.
pub(super) struct Whitened {
    z: DVector<f64>,
    k: DMatrix<f64>,
    /// What a shift that all have in common does to each item, whitened.
    ones: DMatrix<f64>,
}

/// A shift that all errors have in common.
pub(super) struct Shift {
    value: DVector<f64>,
    covariance: DMatrix<f64>,
    pub(super) chi2: f64,
}

impl Shift {
    /// Three of its components, from this one on.
    pub(super) fn three(&self, from: usize) -> Vector3<f64> {
        Vector3::from_fn(|i, _| self.value[from + i])
    }

    /// Their covariance.
    pub(super) fn covariance_of_three(&self, from: usize) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.covariance[(from + i, from + j)])
    }

    /// Their standard deviations.
    pub(super) fn sd_of_three(&self, from: usize) -> Vector3<f64> {
        self.covariance_of_three(from).diagonal().map(f64::sqrt)
    }
}

impl Whitened {
    /// `None` where nothing is predicted of an error, or none counts.
    pub(super) fn of(group: &Group, counts: &[bool]) -> Option<Self> {
        Self::about(group, counts, &|number| {
            let width = group.items[number].error.len();
            DMatrix::identity(width, width)
        })
    }

    /// The same about a shift of something else than the errors themselves; `by`: the derivative of the errors of each item with respect to it.
    pub(super) fn about(group: &Group, counts: &[bool], by: &dyn Fn(usize) -> DMatrix<f64>) -> Option<Self> {
        let root = root(&group.covariance);
        let chosen: Vec<(usize, &Item)> =
            group.items.iter().enumerate().filter(|(number, _)| counts[*number]).collect();
        let width = chosen.first()?.1.error.len();
        let rows = width * chosen.len();
        let (mut z, mut k) = (DVector::zeros(rows), DMatrix::zeros(rows, root.ncols()));
        let mut ones = DMatrix::zeros(rows, by(chosen.first()?.0).ncols());
        let mut before: Option<(usize, DMatrix<f64>)> = None;
        for (i, (number, item)) in chosen.into_iter().enumerate() {
            let from = width * i;
            let (mut own, mut e) = (item.own.clone(), item.error.clone());
            let mut j = &item.by_parameters * &root;
            let mut one = by(number);
            if let (Some((previous, l)), Some(b)) = (&before, &item.with_previous)
                && previous + 1 == number
            {
                let g = l.solve_lower_triangular(&b.transpose())?.transpose();
                let last = from - width;
                own -= &g * g.transpose();
                e -= &g * z.rows(last, width);
                j -= &g * k.rows(last, width);
                one -= &g * ones.rows(last, width);
            }
            let l = own.cholesky()?.l();
            z.rows_mut(from, width).copy_from(&l.solve_lower_triangular(&e)?);
            k.rows_mut(from, width).copy_from(&l.solve_lower_triangular(&j)?);
            ones.rows_mut(from, width).copy_from(&l.solve_lower_triangular(&one)?);
            before = Some((number, l));
        }
        Some(Self { z, k, ones })
    }

    pub(super) fn len(&self) -> usize {
        self.z.len()
    }

    /// `C⁻¹ x`, whitened.
    fn weighed(&self, x: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let size = self.k.ncols();
        let inner = (DMatrix::identity(size, size) + self.k.tr_mul(&self.k)).cholesky()?;
        Some(x - &self.k * inner.solve(&self.k.tr_mul(x)))
    }

    /// `eᵀ C⁻¹ e`.
    pub(super) fn chi2(&self) -> Option<f64> {
        let z = DMatrix::from_column_slice(self.len(), 1, self.z.as_slice());
        Some(self.weighed(&z)?.tr_mul(&z)[(0, 0)].max(0.0))
    }

    /// The shift that explains the errors best (generalised least squares), and how much of χ² it takes.
    pub(super) fn shift(&self) -> Option<Shift> {
        let weighed = self.weighed(&self.ones)?;
        let covariance = weighed.tr_mul(&self.ones).cholesky()?.inverse();
        let h = weighed.tr_mul(&self.z);
        let value = &covariance * &h;
        let chi2 = value.dot(&h).max(0.0);
        Some(Shift { value, covariance, chi2 })
    }

    /// The error along each direction in which the parameters move them, `a_k`, of variance `1 + λ_k` if `Σ` is right; `(a_k², λ_k)`.
    pub(super) fn common_parts(&self) -> Vec<(f64, f64)> {
        let eigen = self.k.tr_mul(&self.k).symmetric_eigen();
        let along = self.k.tr_mul(&self.z);
        let pairs = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter());
        pairs
            .filter(|(value, _)| **value > 0.0)
            .map(|(value, vector)| (vector.dot(&along).powi(2) / value, *value))
            .collect()
    }
}

/// `R` with `R Rᵀ = Σ`, scaled to unit diagonal first so that units do not matter.
fn root(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let sd = covariance.diagonal().map(|variance| variance.max(0.0).sqrt());
    let inverse = sd.map(|sd| if sd > 0.0 { 1.0 / sd } else { 0.0 });
    let size = sd.len();
    let scaled = DMatrix::from_fn(size, size, |i, j| covariance[(i, j)] * inverse[i] * inverse[j]);
    let eigen = scaled.symmetric_eigen();
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    DMatrix::from_fn(size, size, |i, j| sd[i] * eigen.eigenvectors[(i, j)] * roots[j])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::validation::predicted_error::Place;

    #[test]
    fn chi2_and_shift_equal_those_of_the_dense_covariance() {
        let number = |seed: usize| ((seed * 7919 + 13) % 101) as f64 / 50.0 - 1.0;
        let p = 4;
        let half = DMatrix::from_fn(p, p, |i, j| number(3 * i + 17 * j) + if i == j { 2.0 } else { 0.0 });
        // a covariance without a share in one direction, in units far apart
        let units = DVector::from_vec(vec![1.0, 1e4, 1e-5, 1e-2]);
        let mut covariance = &half * half.transpose();
        covariance.row_mut(3).fill(0.0);
        covariance.column_mut(3).fill(0.0);
        let covariance = DMatrix::from_fn(p, p, |i, j| covariance[(i, j)] * units[i] * units[j]);
        let items: Vec<Item> = (0..5)
            .map(|n| {
                let own = DMatrix::from_fn(3, 3, |i, j| number(n + i * 5 + j * 11));
                Item {
                    place: Place {
                        hold: n,
                        from_hold: None,
                        start_s: 0.0,
                        end_s: 1.0,
                        fold: 0,
                        along: Vec::new(),
                    },
                    error: DVector::from_fn(3, |i, _| 3.0 * number(n * 31 + i)),
                    by_parameters: DMatrix::from_fn(3, p, |i, j| number(n * 13 + i * 7 + j) / units[j]),
                    own: &own * own.transpose() + DMatrix::identity(3, 3),
                    // the third and the fourth have nothing in common
                    with_previous: (n > 0 && n != 3)
                        .then(|| DMatrix::from_fn(3, 3, |i, j| 0.4 * number(n * 17 + i * 3 + j * 7))),
                    knock_share: 0.0,
                    scatters: Vec::new(),
                }
            })
            .collect();
        let group = Group { items, covariance };
        for aside in [None, Some(1), Some(4)] {
            equal_those_of_the_dense_covariance(&group, aside);
        }
    }

    fn equal_those_of_the_dense_covariance(group: &Group, aside: Option<usize>) {
        let counts: Vec<bool> = (0..group.items.len()).map(|n| Some(n) != aside).collect();
        let kept: Vec<usize> = (0..group.items.len()).filter(|&n| counts[n]).collect();
        let size = 3 * kept.len();
        let mut dense = DMatrix::zeros(size, size);
        let (mut e, mut ones) = (DVector::zeros(size), DMatrix::zeros(size, 3));
        let zeros = || DMatrix::zeros(3, 3);
        for (i, &n) in kept.iter().enumerate() {
            let one = &group.items[n];
            e.rows_mut(3 * i, 3).copy_from(&one.error);
            ones.view_mut((3 * i, 0), (3, 3)).fill_with_identity();
            for (j, &m) in kept.iter().enumerate() {
                let other = &group.items[m];
                let by_parameters = &one.by_parameters * &group.covariance * other.by_parameters.transpose();
                let own = if n == m {
                    one.own.clone()
                } else if n == m + 1 {
                    one.with_previous.clone().unwrap_or_else(zeros)
                } else if m == n + 1 {
                    other.with_previous.as_ref().map_or_else(zeros, DMatrix::transpose)
                } else {
                    zeros()
                };
                dense.view_mut((3 * i, 3 * j), (3, 3)).copy_from(&(by_parameters + own));
            }
        }
        let inverse = dense.try_inverse().expect("positive definite");
        let whitened = Whitened::of(group, &counts).expect("predicted");
        let chi2 = (e.transpose() * &inverse * &e)[(0, 0)];
        assert!((whitened.chi2().expect("regular") / chi2 - 1.0).abs() < 1e-10);
        let of_shift = (ones.transpose() * &inverse * &ones).try_inverse().expect("regular");
        let value = &of_shift * ones.transpose() * &inverse * &e;
        let shift = whitened.shift().expect("regular");
        assert!((&shift.value - &value).norm() < 1e-10 * value.norm());
        let left = &e - &ones * &value;
        let rest = (left.transpose() * &inverse * &left)[(0, 0)];
        assert!((chi2 - shift.chi2 - rest).abs() < 1e-10 * chi2);
        assert!((shift.covariance[(0, 1)] - of_shift[(0, 1)]).abs() < 1e-12);
        assert_eq!(whitened.common_parts().iter().filter(|part| part.1 > 1e-12).count(), 3);
    }
}
