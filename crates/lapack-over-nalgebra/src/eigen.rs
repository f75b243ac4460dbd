//! Eigenvalues and eigenvectors of a symmetric matrix: `dsyevr`.

use crate::Triangle;
use nalgebra::{DMatrix, SymmetricEigen};

/// Largest number of sweeps for each row: QR takes about two.
const SWEEPS: usize = 60;

/// Eigenvalues in ascending order, and the eigenvectors in the same order where they are wanted.
pub(crate) fn syevr(
    triangle: Triangle,
    n: usize,
    a: &[f64],
    lda: usize,
    vectors: bool,
) -> Option<(Vec<f64>, Option<DMatrix<f64>>)> {
    let full = DMatrix::from_fn(n, n, |i, j| {
        let (row, column) = match triangle {
            Triangle::Upper => (i.min(j), i.max(j)),
            Triangle::Lower => (i.max(j), i.min(j)),
        };
        a[row + column * lda]
    });
    if !full.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    if n == 0 {
        return Some((Vec::new(), vectors.then_some(full)));
    }
    if !vectors {
        let mut values = full.symmetric_eigenvalues().as_slice().to_vec();
        values.sort_by(f64::total_cmp);
        return Some((values, None));
    }
    let eigen = SymmetricEigen::try_new(full, f64::EPSILON, SWEEPS * n)?;
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
    let values = order.iter().map(|&i| eigen.eigenvalues[i]).collect();
    let vectors = DMatrix::from_fn(n, n, |i, j| eigen.eigenvectors[(i, order[j])]);
    Some((values, Some(vectors)))
}
