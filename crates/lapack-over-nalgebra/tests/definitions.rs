//! Tests of each routine against its definition, called as Fortran calls it: with padded leading dimensions,
//! both triangles, transposes.

#![allow(clippy::borrow_as_ptr, reason = "Fortran passes everything by reference")]
use lapack_over_nalgebra::symbols::*;
use nalgebra::DMatrix;
use std::ffi::{c_char, c_int};

/// LAPACK's letter for an operand that is not transposed.
const N: c_char = b'N' as c_char;
/// LAPACK's letter for a transposed operand.
const T: c_char = b'T' as c_char;
/// The value of padding: no routine may read it or write it.
const PADDING: f64 = f64::NAN;

/// Reproducible numbers in [−1, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn matrix(&mut self, rows: usize, columns: usize) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |_, _| self.next())
    }
}

/// Column-major with `padding` unused rows.
fn padded(matrix: &DMatrix<f64>, padding: usize) -> (Vec<f64>, c_int) {
    let ld = matrix.nrows() + padding;
    let mut data = vec![PADDING; ld * matrix.ncols()];
    for (j, column) in matrix.column_iter().enumerate() {
        data[j * ld..j * ld + matrix.nrows()].copy_from_slice(column.as_slice());
    }
    (data, ld as c_int)
}

fn unpadded(data: &[f64], ld: c_int, rows: usize, columns: usize) -> DMatrix<f64> {
    for column in data.chunks(ld as usize) {
        assert!(column[rows..].iter().all(|x| x.is_nan()), "padding was written");
    }
    DMatrix::from_fn(rows, columns, |i, j| data[i + j * ld as usize])
}

fn stored(matrix: &DMatrix<f64>, uplo: u8) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
        if (uplo == b'U') == (i < j) || i == j { matrix[(i, j)] } else { PADDING }
    })
}

/// Equal in the stored triangle, and the other one untouched.
fn assert_triangle(found: &DMatrix<f64>, expected: &DMatrix<f64>, uplo: u8) {
    for j in 0..found.ncols() {
        for i in 0..found.nrows() {
            if i == j || (uplo == b'U') == (i < j) {
                assert!((found[(i, j)] - expected[(i, j)]).abs() < 1e-13, "({i}, {j})");
            } else {
                assert!(found[(i, j)].is_nan(), "the other triangle was written");
            }
        }
    }
}

#[test]
fn dgemm_is_alpha_op_a_op_b_plus_beta_c() {
    let mut numbers = Numbers(1);
    for (m, n, k) in [(1, 1, 1), (3, 4, 5), (15, 15, 15), (7, 2, 21), (4, 3, 0)] {
        for (ta, tb) in [(N, N), (N, T), (T, N), (T, T)] {
            for (alpha, beta) in [(1.0, 0.0), (-0.5, 2.0), (0.0, 0.0), (0.0, 3.0)] {
                let (a, b, c) = (numbers.matrix(m, k), numbers.matrix(k, n), numbers.matrix(m, n));
                let (pa, lda) = padded(&if ta == N { a.clone() } else { a.transpose() }, 2);
                let (pb, ldb) = padded(&if tb == N { b.clone() } else { b.transpose() }, 1);
                // C is not read where β = 0
                let (mut pc, ldc) = padded(&if beta == 0.0 { c.map(|_| f64::NAN) } else { c.clone() }, 3);
                let sizes = [m, n, k].map(|x| x as c_int);
                unsafe {
                    dgemm_(
                        &ta,
                        &tb,
                        &sizes[0],
                        &sizes[1],
                        &sizes[2],
                        &alpha,
                        pa.as_ptr(),
                        &lda,
                        pb.as_ptr(),
                        &ldb,
                        &beta,
                        pc.as_mut_ptr(),
                        &ldc,
                    );
                }
                let expected = &a * &b * alpha + &c * beta;
                assert!((unpadded(&pc, ldc, m, n) - expected).amax() < 1e-13, "{m} {n} {k} {ta} {tb}");
            }
        }
    }
}

#[test]
fn dsyrk_and_dsyr2k_are_one_triangle_of_the_symmetric_products() {
    let mut numbers = Numbers(2);
    for (n, k) in [(1, 1), (4, 6), (15, 15), (6, 3)] {
        for uplo in *b"UL" {
            for (trans, beta) in [(N, 0.0), (T, 0.0), (N, 2.0), (T, -1.0)] {
                let (a, b, c) = (numbers.matrix(n, k), numbers.matrix(n, k), numbers.matrix(n, n));
                let shown = |x: &DMatrix<f64>| if trans == N { x.clone() } else { x.transpose() };
                let ((pa, lda), (pb, ldb)) = (padded(&shown(&a), 1), padded(&shown(&b), 2));
                let start = stored(&c, uplo);
                let sizes = [n, k].map(|x| x as c_int);
                let (letter, alpha) = (uplo as c_char, 0.7);

                let (mut pc, ldc) = padded(&start, 1);
                unsafe {
                    dsyrk_(
                        &letter,
                        &trans,
                        &sizes[0],
                        &sizes[1],
                        &alpha,
                        pa.as_ptr(),
                        &lda,
                        &beta,
                        pc.as_mut_ptr(),
                        &ldc,
                    );
                }
                assert_triangle(&unpadded(&pc, ldc, n, n), &(&a * a.transpose() * alpha + &c * beta), uplo);

                let (mut pc, ldc) = padded(&start, 1);
                unsafe {
                    dsyr2k_(
                        &letter,
                        &trans,
                        &sizes[0],
                        &sizes[1],
                        &alpha,
                        pa.as_ptr(),
                        &lda,
                        pb.as_ptr(),
                        &ldb,
                        &beta,
                        pc.as_mut_ptr(),
                        &ldc,
                    );
                }
                let product = &a * b.transpose();
                let expected = (&product + product.transpose()) * alpha + &c * beta;
                assert_triangle(&unpadded(&pc, ldc, n, n), &expected, uplo);
            }
        }
    }
}

#[test]
fn dpotrf_factors_and_dpotrs_solves() {
    let mut numbers = Numbers(3);
    for n in [1, 2, 5, 15] {
        for uplo in *b"UL" {
            let g = numbers.matrix(n, n + 2);
            let (a, b) = (&g * g.transpose(), numbers.matrix(n, 3));
            let (mut pa, lda) = padded(&stored(&a, uplo), 2);
            let (mut pb, ldb) = padded(&b, 1);
            let (letter, size, columns, mut info) = (uplo as c_char, n as c_int, 3, -9);
            unsafe { dpotrf_(&letter, &size, pa.as_mut_ptr(), &lda, &mut info) };
            assert_eq!(info, 0);
            let factor = unpadded(&pa, lda, n, n).map(|x| if x.is_nan() { 0.0 } else { x });
            let product =
                if uplo == b'U' { factor.transpose() * &factor } else { &factor * factor.transpose() };
            assert!((product - &a).amax() < 1e-13 * a.amax() * n as f64);
            unsafe { dpotrs_(&letter, &size, &columns, pa.as_ptr(), &lda, pb.as_mut_ptr(), &ldb, &mut info) };
            assert_eq!(info, 0);
            assert!((&a * unpadded(&pb, ldb, n, 3) - b).amax() < 1e-9);
        }
    }
}

#[test]
fn dpotrf_names_the_minor_that_is_not_positive_definite() {
    let a = DMatrix::from_row_slice(3, 3, &[4.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    for uplo in *b"UL" {
        let (mut pa, lda) = padded(&stored(&a, uplo), 0);
        let mut info = 0;
        unsafe { dpotrf_(&(uplo as c_char), &3, pa.as_mut_ptr(), &lda, &mut info) };
        assert_eq!(info, 2);
    }
}

/// Calls `dsyevr` twice as LAPACK requires: a workspace query, then the work.
fn syevr(
    a: &DMatrix<f64>,
    (jobz, range, uplo): (u8, u8, u8),
    (vl, vu): (f64, f64),
    (il, iu): (c_int, c_int),
) -> (c_int, Vec<f64>, DMatrix<f64>) {
    let n = a.nrows();
    let (mut pa, lda) = padded(&stored(a, uplo), 2);
    let (mut w, mut z, ldz) = (vec![PADDING; n], vec![PADDING; (n + 1) * n], n as c_int + 1);
    let (mut isuppz, mut work, mut iwork) = (vec![0; 2 * n], vec![0.0], vec![0]);
    let (mut m, mut info, mut lwork, mut liwork) = (0, -9, -1, -1);
    for _ in 0..2 {
        unsafe {
            dsyevr_(
                &(jobz as c_char),
                &(range as c_char),
                &(uplo as c_char),
                &(n as c_int),
                pa.as_mut_ptr(),
                &lda,
                &vl,
                &vu,
                &il,
                &iu,
                &-1.0,
                &mut m,
                w.as_mut_ptr(),
                z.as_mut_ptr(),
                &ldz,
                isuppz.as_mut_ptr(),
                work.as_mut_ptr(),
                &lwork,
                iwork.as_mut_ptr(),
                &liwork,
                &mut info,
            );
        }
        (lwork, liwork) = (work[0] as c_int, iwork[0]);
        work.resize(lwork as usize, 0.0);
        iwork.resize(liwork as usize, 0);
    }
    w.truncate(m as usize);
    let vectors = DMatrix::from_fn(n, m as usize, |i, j| z[i + j * (n + 1)]);
    (info, w, vectors)
}

#[test]
fn dsyevr_finds_all_eigenvalues_in_order_with_their_vectors() {
    let mut numbers = Numbers(4);
    for n in [1, 2, 4, 15, 21] {
        let g = numbers.matrix(n, n);
        let a = &g + g.transpose();
        for uplo in *b"UL" {
            let (info, values, vectors) = syevr(&a, (b'V', b'A', uplo), (0.0, 0.0), (0, 0));
            assert_eq!(info, 0);
            assert!(values.windows(2).all(|pair| pair[0] <= pair[1]));
            let diagonal = DMatrix::from_diagonal(&values.clone().into());
            assert!((&a * &vectors - &vectors * diagonal).amax() < 1e-12);
            assert!((vectors.transpose() * &vectors - DMatrix::identity(n, n)).amax() < 1e-12);
            let (_, only, _) = syevr(&a, (b'N', b'A', uplo), (0.0, 0.0), (0, 0));
            assert!(only.iter().zip(&values).all(|(x, y)| (x - y).abs() < 1e-12));
        }
    }
}

#[test]
fn dsyevr_finds_a_range_of_eigenvalues() {
    let a = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(vec![5.0, 1.0, 4.0, 2.0, 3.0]));
    let (_, by_value, vectors) = syevr(&a, (b'V', b'V', b'U'), (1.0, 3.5), (0, 0));
    assert_eq!(by_value, [2.0, 3.0], "the half-open interval (vl, vu]");
    assert_eq!(vectors.map(f64::abs).column(0).as_slice(), [0.0, 0.0, 0.0, 1.0, 0.0]);
    let (_, by_order, _) = syevr(&a, (b'N', b'I', b'L'), (0.0, 0.0), (2, 4));
    assert_eq!(by_order, [2.0, 3.0, 4.0]);
    let (info, ..) = syevr(&a.map(|_| f64::INFINITY), (b'N', b'A', b'U'), (0.0, 0.0), (0, 0));
    assert_eq!(info, 1, "not finite");
}

/// Both singular value decompositions, each with its workspace query.
fn svd(a: &DMatrix<f64>, divide: bool, job: u8) -> (c_int, Vec<f64>, DMatrix<f64>, DMatrix<f64>) {
    let (m, n) = a.shape();
    let k = m.min(n);
    let (mut pa, lda) = padded(a, 2);
    let (mut s, mut u, mut vt) = (vec![PADDING; k], vec![PADDING; (m + 1) * k], vec![PADDING; (k + 2) * n]);
    let (ldu, ldvt, job) = (m as c_int + 1, k as c_int + 2, job as c_char);
    let (mut work, mut iwork, mut lwork, mut info) = (vec![0.0], vec![0; 8 * k], -1, -9);
    let (rows, columns) = (m as c_int, n as c_int);
    for _ in 0..2 {
        unsafe {
            if divide {
                dgesdd_(
                    &job,
                    &rows,
                    &columns,
                    pa.as_mut_ptr(),
                    &lda,
                    s.as_mut_ptr(),
                    u.as_mut_ptr(),
                    &ldu,
                    vt.as_mut_ptr(),
                    &ldvt,
                    work.as_mut_ptr(),
                    &lwork,
                    iwork.as_mut_ptr(),
                    &mut info,
                );
            } else {
                dgesvd_(
                    &job,
                    &job,
                    &rows,
                    &columns,
                    pa.as_mut_ptr(),
                    &lda,
                    s.as_mut_ptr(),
                    u.as_mut_ptr(),
                    &ldu,
                    vt.as_mut_ptr(),
                    &ldvt,
                    work.as_mut_ptr(),
                    &lwork,
                    &mut info,
                );
            }
        }
        lwork = work[0] as c_int;
        work.resize(lwork.max(1) as usize, 0.0);
    }
    let u = DMatrix::from_fn(m, k, |i, j| u[i + j * (m + 1)]);
    let vt = DMatrix::from_fn(k, n, |i, j| vt[i + j * (k + 2)]);
    (info, s, u, vt)
}

#[test]
fn both_singular_value_decompositions_rebuild_the_matrix() {
    let mut numbers = Numbers(5);
    for (m, n) in [(1, 1), (4, 4), (15, 15), (6, 3), (3, 6)] {
        let k = m.min(n);
        let mut deficient = numbers.matrix(m, n);
        deficient.set_row(m - 1, &(deficient.row(0) * 2.0));
        // eight orders of magnitude between columns, as in the last steps of an interior-point method
        let mut graded = numbers.matrix(m, n);
        for (j, mut column) in graded.column_iter_mut().enumerate() {
            column *= 10.0_f64.powf(-8.0 * j as f64 / n as f64);
        }
        for a in [numbers.matrix(m, n), deficient, graded, DMatrix::identity(m, n), DMatrix::zeros(m, n)] {
            for divide in [true, false] {
                let (info, s, u, vt) = svd(&a, divide, b'S');
                assert_eq!(info, 0);
                assert!(s.windows(2).all(|pair| pair[0] >= pair[1]) && s[k - 1] >= 0.0, "descending: {s:?}");
                let rebuilt = &u * DMatrix::from_diagonal(&s.clone().into()) * &vt;
                assert!((rebuilt - &a).amax() < 1e-12, "{m} × {n}");
                assert!((u.transpose() * &u - DMatrix::identity(k, k)).amax() < 1e-12);
                assert!((&vt * vt.transpose() - DMatrix::identity(k, k)).amax() < 1e-12);
                let (_, values, no_u, _) = svd(&a, divide, b'N');
                assert!(values.iter().zip(&s).all(|(x, y)| (x - y).abs() < 1e-12));
                assert!(no_u.iter().all(|x| x.is_nan()), "no vectors were asked for");
            }
        }
    }
}

#[test]
fn singular_value_decompositions_refuse_what_they_do_not_provide() {
    let a = DMatrix::identity(4, 4);
    assert_eq!(svd(&a, true, b'A').0, -1);
    assert_eq!(svd(&a, false, b'O').0, -1);
    assert_eq!(svd(&a.map(|_| f64::NAN), true, b'S').0, 1);
}
