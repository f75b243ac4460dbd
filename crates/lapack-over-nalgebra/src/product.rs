//! Matrix products `dgemm`, `dsyrk`, `dsyr2k`. They are loops of our own, since nalgebra's products need
//! operands with contiguous columns.

use crate::Triangle;

/// An operand: column-major data, leading dimension, and whether it is used transposed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Operand<'a> {
    pub(crate) data: &'a [f64],
    pub(crate) ld: usize,
    pub(crate) transposed: bool,
}

impl<'a> Operand<'a> {
    /// `length` entries of stored column `j`.
    fn stored(self, j: usize, length: usize) -> &'a [f64] {
        if length == 0 { &[] } else { &self.data[j * self.ld..j * self.ld + length] }
    }

    fn at(self, row: usize, column: usize) -> f64 {
        if self.transposed { self.data[column + row * self.ld] } else { self.data[row + column * self.ld] }
    }
}

/// `C ← α op(A) op(B) + β C`, C of m × n, `op(A)` of m × k. With `β = 0`, C is not read.
pub(crate) fn gemm(
    (m, n, k): (usize, usize, usize),
    alpha: f64,
    a: Operand<'_>,
    b: Operand<'_>,
    beta: f64,
    c: &mut [f64],
    ldc: usize,
) {
    for j in 0..n {
        let column = &mut c[j * ldc..j * ldc + m];
        if beta == 0.0 {
            column.fill(0.0);
        } else if beta != 1.0 {
            column.iter_mut().for_each(|entry| *entry *= beta);
        }
        if a.transposed {
            for (i, entry) in column.iter_mut().enumerate() {
                let row = a.stored(i, k).iter().enumerate();
                *entry += alpha * row.map(|(l, x)| x * b.at(l, j)).sum::<f64>();
            }
        } else {
            for l in 0..k {
                let weight = alpha * b.at(l, j);
                column.iter_mut().zip(a.stored(l, m)).for_each(|(entry, x)| *entry += weight * x);
            }
        }
    }
}

/// `C ← α op(A) op(A)ᵀ + β C`, one triangle of the n × n matrix C; `op(A)` of n × k.
pub(crate) fn syrk(
    triangle: Triangle,
    (n, k): (usize, usize),
    alpha: f64,
    a: Operand<'_>,
    beta: f64,
    c: &mut [f64],
    ldc: usize,
) {
    symmetric(triangle, n, beta, c, ldc, |i, j| alpha * (0..k).map(|l| a.at(i, l) * a.at(j, l)).sum::<f64>());
}

/// `C ← α (op(A) op(B)ᵀ + op(B) op(A)ᵀ) + β C`, one triangle of the n × n matrix C.
#[allow(clippy::too_many_arguments, reason = "the routine's own list")]
pub(crate) fn syr2k(
    triangle: Triangle,
    (n, k): (usize, usize),
    alpha: f64,
    a: Operand<'_>,
    b: Operand<'_>,
    beta: f64,
    c: &mut [f64],
    ldc: usize,
) {
    symmetric(triangle, n, beta, c, ldc, |i, j| {
        alpha * (0..k).map(|l| a.at(i, l) * b.at(j, l) + b.at(i, l) * a.at(j, l)).sum::<f64>()
    });
}

fn symmetric(
    triangle: Triangle,
    n: usize,
    beta: f64,
    c: &mut [f64],
    ldc: usize,
    product: impl Fn(usize, usize) -> f64,
) {
    for j in 0..n {
        for i in triangle.rows(j, n) {
            let entry = &mut c[i + j * ldc];
            let old = if beta == 0.0 { 0.0 } else { beta * *entry };
            *entry = old + product(i, j);
        }
    }
}
