//! The eight BLAS and LAPACK symbols that Clarabel's semidefinite cone calls, built on nalgebra: no C, no
//! Fortran.
//!
//! Clarabel with its feature `sdp` calls `dgemm dsyrk dsyr2k dpotrf dpotrs dsyevr dgesdd dgesvd` by their
//! Fortran names. Its matrices have some tens of rows. A system BLAS would gain nothing and cost every user a
//! C or Fortran tool chain.
//!
//! # Use
//! Write `use lapack_over_nalgebra as _;` in the crate that uses Clarabel: nothing is called by name, the
//! linker finds the symbols. A program that links another BLAS must not link this crate: the symbols would be
//! there twice.
//!
//! # Contents
//! The safe routines, on column-major slices with a leading dimension, are in one file per kind. [`symbols`]
//! is the thin unsafe layer that turns Fortran's pointers into slices. The crate has only what Clarabel
//! needs: `f64`, and the economy size of the singular value decomposition (`jobz`, `jobu`, `jobvt` = `S` or
//! `N`). Everything else returns LAPACK's `info < 0`.
//!
//! # References
//! `anderson1999` (LAPACK Users' Guide)

mod cholesky;
mod eigen;
mod product;
mod svd;
pub mod symbols;

/// Which triangle of a symmetric matrix is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Triangle {
    Upper,
    Lower,
}

impl Triangle {
    /// From LAPACK's `uplo`: everything that is not `U` or `u` is lower.
    fn from_char(uplo: u8) -> Self {
        if uplo.eq_ignore_ascii_case(&b'U') { Self::Upper } else { Self::Lower }
    }

    /// Rows of column `j` that are stored, of `n`.
    fn rows(self, j: usize, n: usize) -> std::ops::Range<usize> {
        match self {
            Self::Upper => 0..j + 1,
            Self::Lower => j..n,
        }
    }
}

/// Is the operand transposed? LAPACK's `trans`; for real numbers `C` is `T`.
fn transposed(trans: u8) -> bool {
    !trans.eq_ignore_ascii_case(&b'N')
}
