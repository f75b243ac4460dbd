//! Singular value decomposition in its economy size: `dgesdd`, `dgesvd`.

use nalgebra::{DMatrix, DMatrixView, Dyn, SVD};

/// Largest number of sweeps for each singular value: QR takes about two.
const SWEEPS: usize = 60;

/// `A = U diag(s) Vᵀ` with s descending, U of m × min(m, n), Vᵀ of min(m, n) × n.
#[derive(Debug)]
pub(crate) struct Decomposition {
    pub(crate) s: Vec<f64>,
    pub(crate) u: Option<DMatrix<f64>>,
    pub(crate) vt: Option<DMatrix<f64>>,
}

/// Decomposes; `None` where A is not finite or the iteration does not end.
pub(crate) fn svd(
    (m, n): (usize, usize),
    a: &[f64],
    lda: usize,
    want_u: bool,
    want_vt: bool,
) -> Option<Decomposition> {
    if m == 0 || n == 0 {
        let (u, vt) = (want_u.then(|| DMatrix::zeros(m, 0)), want_vt.then(|| DMatrix::zeros(0, n)));
        return Some(Decomposition { s: Vec::new(), u, vt });
    }
    let a = DMatrixView::from_slice_with_strides_generic(a, Dyn(m), Dyn(n), Dyn(1), Dyn(lda)).into_owned();
    if !a.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let svd = SVD::try_new(a, want_u, want_vt, f64::EPSILON, SWEEPS * m.max(n))?;
    Some(Decomposition { s: svd.singular_values.as_slice().to_vec(), u: svd.u, vt: svd.v_t })
}
