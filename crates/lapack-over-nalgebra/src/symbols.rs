//! The Fortran symbols: pointers become slices, and nothing else happens here.
//!
//! # Safety
//! The rules are LAPACK's. Every pointer is valid for the length that its dimensions and leading dimension
//! imply. Arrays that are written to overlap no other argument. Dimensions are not negative. A workspace
//! query (`lwork = −1`) returns 1: no workspace is used.

#![allow(clippy::missing_safety_doc, reason = "one contract for all, in the module's documentation")]
#![allow(clippy::too_many_arguments, reason = "Fortran's signatures")]

use crate::product::Operand;
use crate::{Triangle, cholesky, eigen, product, svd, transposed};
use nalgebra::DMatrix;
use std::ffi::{c_char, c_int};

/// Dimension or leading dimension behind a pointer.
unsafe fn size(pointer: *const c_int) -> usize {
    usize::try_from(unsafe { *pointer }).unwrap_or(0)
}

unsafe fn letter(pointer: *const c_char) -> u8 {
    unsafe { *pointer.cast::<u8>() }
}

/// Entries that a column-major matrix occupies.
fn extent(rows: usize, columns: usize, ld: usize) -> usize {
    if rows == 0 || columns == 0 { 0 } else { ld * (columns - 1) + rows }
}

unsafe fn input<'a>(pointer: *const f64, length: usize) -> &'a [f64] {
    if length == 0 { &[] } else { unsafe { std::slice::from_raw_parts(pointer, length) } }
}

unsafe fn output<'a>(pointer: *mut f64, length: usize) -> &'a mut [f64] {
    if length == 0 { &mut [] } else { unsafe { std::slice::from_raw_parts_mut(pointer, length) } }
}

/// The operand `op(X)` of `rows × columns`, as stored.
unsafe fn operand<'a>(trans: u8, data: *const f64, ld: usize, rows: usize, columns: usize) -> Operand<'a> {
    let transposed = transposed(trans);
    let length = if transposed { extent(columns, rows, ld) } else { extent(rows, columns, ld) };
    Operand { data: unsafe { input(data, length) }, ld, transposed }
}

unsafe fn store(matrix: &DMatrix<f64>, to: *mut f64, ld: usize) {
    let to = unsafe { output(to, extent(matrix.nrows(), matrix.ncols(), ld)) };
    for (j, column) in matrix.column_iter().enumerate() {
        to[j * ld..j * ld + matrix.nrows()].copy_from_slice(column.as_slice());
    }
}

/// `C ← α op(A) op(B) + β C`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dgemm_(
    transa: *const c_char,
    transb: *const c_char,
    m: *const c_int,
    n: *const c_int,
    k: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    b: *const f64,
    ldb: *const c_int,
    beta: *const f64,
    c: *mut f64,
    ldc: *const c_int,
) {
    unsafe {
        let (m, n, k, ldc) = (size(m), size(n), size(k), size(ldc));
        let a = operand(letter(transa), a, size(lda), m, k);
        let b = operand(letter(transb), b, size(ldb), k, n);
        product::gemm((m, n, k), *alpha, a, b, *beta, output(c, extent(m, n, ldc)), ldc);
    }
}

/// `C ← α op(A) op(A)ᵀ + β C`, one triangle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dsyrk_(
    uplo: *const c_char,
    trans: *const c_char,
    n: *const c_int,
    k: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    beta: *const f64,
    c: *mut f64,
    ldc: *const c_int,
) {
    unsafe {
        let (n, k, ldc) = (size(n), size(k), size(ldc));
        let a = operand(letter(trans), a, size(lda), n, k);
        let c = output(c, extent(n, n, ldc));
        product::syrk(Triangle::from_char(letter(uplo)), (n, k), *alpha, a, *beta, c, ldc);
    }
}

/// `C ← α (op(A) op(B)ᵀ + op(B) op(A)ᵀ) + β C`, one triangle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dsyr2k_(
    uplo: *const c_char,
    trans: *const c_char,
    n: *const c_int,
    k: *const c_int,
    alpha: *const f64,
    a: *const f64,
    lda: *const c_int,
    b: *const f64,
    ldb: *const c_int,
    beta: *const f64,
    c: *mut f64,
    ldc: *const c_int,
) {
    unsafe {
        let (n, k, ldc) = (size(n), size(k), size(ldc));
        let a = operand(letter(trans), a, size(lda), n, k);
        let b = operand(letter(trans), b, size(ldb), n, k);
        let c = output(c, extent(n, n, ldc));
        product::syr2k(Triangle::from_char(letter(uplo)), (n, k), *alpha, a, b, *beta, c, ldc);
    }
}

/// Cholesky factorisation in place of one triangle. `info = k > 0`: the leading minor of order k is not positive definite.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dpotrf_(
    uplo: *const c_char,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    info: *mut c_int,
) {
    unsafe {
        let (n, lda) = (size(n), size(lda));
        let a = output(a, extent(n, n, lda));
        *info = match cholesky::potrf(Triangle::from_char(letter(uplo)), n, a, lda) {
            Ok(()) => 0,
            Err(order) => order as c_int,
        };
    }
}

/// Solves `A X = B` from the Cholesky factor.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dpotrs_(
    uplo: *const c_char,
    n: *const c_int,
    nrhs: *const c_int,
    a: *const f64,
    lda: *const c_int,
    b: *mut f64,
    ldb: *const c_int,
    info: *mut c_int,
) {
    unsafe {
        let (n, columns, lda, ldb) = (size(n), size(nrhs), size(lda), size(ldb));
        let factor = input(a, extent(n, n, lda));
        let b = output(b, extent(n, columns, ldb));
        cholesky::potrs(Triangle::from_char(letter(uplo)), (n, columns), factor, lda, b, ldb);
        *info = 0;
    }
}

/// Eigenvalues (ascending) and, with `jobz = V`, eigenvectors of a symmetric matrix.
///
/// `range`: `A` all, `V` those in `(vl, vu]`, `I` the `il`-th to the `iu`-th. `info = 1`: not finite, or no convergence.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dsyevr_(
    jobz: *const c_char,
    range: *const c_char,
    uplo: *const c_char,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    vl: *const f64,
    vu: *const f64,
    il: *const c_int,
    iu: *const c_int,
    _abstol: *const f64,
    m: *mut c_int,
    w: *mut f64,
    z: *mut f64,
    ldz: *const c_int,
    isuppz: *mut c_int,
    work: *mut f64,
    lwork: *const c_int,
    iwork: *mut c_int,
    liwork: *const c_int,
    info: *mut c_int,
) {
    unsafe {
        *info = 0;
        if *lwork == -1 || *liwork == -1 {
            *work = 1.0;
            *iwork = 1;
            return;
        }
        let (n, lda) = (size(n), size(lda));
        let vectors = letter(jobz).eq_ignore_ascii_case(&b'V');
        let triangle = Triangle::from_char(letter(uplo));
        let Some((values, eigenvectors)) =
            eigen::syevr(triangle, n, input(a, extent(n, n, lda)), lda, vectors)
        else {
            *info = 1;
            return;
        };
        let wanted = match letter(range).to_ascii_uppercase() {
            b'V' => values.partition_point(|&x| x <= *vl)..values.partition_point(|&x| x <= *vu),
            b'I' => size(il).saturating_sub(1)..size(iu).min(n),
            _ => 0..n,
        };
        output(w, wanted.len()).copy_from_slice(&values[wanted.clone()]);
        *m = wanted.len() as c_int;
        if let Some(vectors) = eigenvectors {
            store(&vectors.columns(wanted.start, wanted.len()).into_owned(), z, size(ldz));
            for k in 0..wanted.len() {
                *isuppz.add(2 * k) = 1;
                *isuppz.add(2 * k + 1) = n as c_int;
            }
        }
    }
}

/// The common part of both singular value decompositions.
unsafe fn decompose(
    (m, n): (usize, usize),
    a: *mut f64,
    lda: usize,
    s: *mut f64,
    u: Option<(*mut f64, usize)>,
    vt: Option<(*mut f64, usize)>,
    info: *mut c_int,
) {
    unsafe {
        let a = input(a, extent(m, n, lda));
        let Some(found) = svd::svd((m, n), a, lda, u.is_some(), vt.is_some()) else {
            *info = 1;
            return;
        };
        *info = 0;
        output(s, found.s.len()).copy_from_slice(&found.s);
        for (matrix, place) in [(found.u, u), (found.vt, vt)] {
            if let (Some(matrix), Some((to, ld))) = (matrix, place) {
                store(&matrix, to, ld);
            }
        }
    }
}

/// Is a factor wanted? `S` economy size, `N` none; anything else is not provided.
fn wanted(job: u8) -> Option<bool> {
    match job.to_ascii_uppercase() {
        b'S' => Some(true),
        b'N' => Some(false),
        _ => None,
    }
}

/// Singular value decomposition, economy size. `jobz`: `S` or `N`. `info = 1`: not finite, or no convergence.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dgesdd_(
    jobz: *const c_char,
    m: *const c_int,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    s: *mut f64,
    u: *mut f64,
    ldu: *const c_int,
    vt: *mut f64,
    ldvt: *const c_int,
    work: *mut f64,
    lwork: *const c_int,
    _iwork: *mut c_int,
    info: *mut c_int,
) {
    unsafe {
        let Some(vectors) = wanted(letter(jobz)) else {
            *info = -1;
            return;
        };
        if *lwork == -1 {
            *work = 1.0;
            *info = 0;
            return;
        }
        let (u, vt) = (vectors.then(|| (u, size(ldu))), vectors.then(|| (vt, size(ldvt))));
        decompose((size(m), size(n)), a, size(lda), s, u, vt, info);
    }
}

/// Singular value decomposition, economy size. `jobu`, `jobvt`: `S` or `N`. `info = 1`: not finite, or no convergence.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dgesvd_(
    jobu: *const c_char,
    jobvt: *const c_char,
    m: *const c_int,
    n: *const c_int,
    a: *mut f64,
    lda: *const c_int,
    s: *mut f64,
    u: *mut f64,
    ldu: *const c_int,
    vt: *mut f64,
    ldvt: *const c_int,
    work: *mut f64,
    lwork: *const c_int,
    info: *mut c_int,
) {
    unsafe {
        let (want_u, want_vt) = (wanted(letter(jobu)), wanted(letter(jobvt)));
        let (Some(want_u), Some(want_vt)) = (want_u, want_vt) else {
            *info = if want_u.is_none() { -1 } else { -2 };
            return;
        };
        if *lwork == -1 {
            *work = 1.0;
            *info = 0;
            return;
        }
        let (u, vt) = (want_u.then(|| (u, size(ldu))), want_vt.then(|| (vt, size(ldvt))));
        decompose((size(m), size(n)), a, size(lda), s, u, vt, info);
    }
}
