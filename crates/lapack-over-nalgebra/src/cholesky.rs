//! Cholesky factorisation and solution: `dpotrf`, `dpotrs`.

use crate::Triangle;
use nalgebra::{DMatrixView, DMatrixViewMut, Dyn};

/// Factors one triangle of A in place: `A = Uᵀ U` or `A = L Lᵀ`. It does not touch the other triangle.
///
/// # Errors
/// The order, from 1, of the leading minor that is not positive definite.
pub(crate) fn potrf(triangle: Triangle, n: usize, a: &mut [f64], lda: usize) -> Result<(), usize> {
    // the entry (row, column) of L, wherever it is stored
    let at = |row: usize, column: usize| match triangle {
        Triangle::Lower => row + column * lda,
        Triangle::Upper => column + row * lda,
    };
    for j in 0..n {
        let pivot = a[at(j, j)] - (0..j).map(|k| a[at(j, k)] * a[at(j, k)]).sum::<f64>();
        if pivot.is_nan() || pivot <= 0.0 {
            return Err(j + 1);
        }
        let diagonal = pivot.sqrt();
        a[at(j, j)] = diagonal;
        for i in j + 1..n {
            let rest = a[at(i, j)] - (0..j).map(|k| a[at(i, k)] * a[at(j, k)]).sum::<f64>();
            a[at(i, j)] = rest / diagonal;
        }
    }
    Ok(())
}

/// Solves `A X = B` in place of B from the factor that [`potrf`] left.
pub(crate) fn potrs(
    triangle: Triangle,
    (n, columns): (usize, usize),
    factor: &[f64],
    lda: usize,
    b: &mut [f64],
    ldb: usize,
) {
    if n == 0 || columns == 0 {
        return;
    }
    let factor = DMatrixView::from_slice_with_strides_generic(factor, Dyn(n), Dyn(n), Dyn(1), Dyn(lda));
    let mut b = DMatrixViewMut::from_slice_with_strides_generic(b, Dyn(n), Dyn(columns), Dyn(1), Dyn(ldb));
    match triangle {
        Triangle::Lower => {
            factor.solve_lower_triangular_mut(&mut b);
            factor.tr_solve_lower_triangular_mut(&mut b);
        }
        Triangle::Upper => {
            factor.tr_solve_upper_triangular_mut(&mut b);
            factor.solve_upper_triangular_mut(&mut b);
        }
    }
}
