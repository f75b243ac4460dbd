//! The equations of one step: `[H Gᵀ; G 0] [Δy; Δλ] = [r; s]`, H with one block for each clique.
//!
//! Each row of G couples two neighbours. With `H = L Lᵀ` and `B = L⁻¹ Gᵀ`, the multipliers follow from
//! `BᵀB Δλ = B ᵀL⁻¹r − s`, whose matrix is block tridiagonal along the chain. Its Cholesky factor is, too.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// What couples a clique to the next one: `before y_k + after y_{k+1} + constant = 0`.
#[derive(Debug, Clone)]
pub(super) struct Coupling {
    pub(super) before: DMatrix<f64>,
    pub(super) after: DMatrix<f64>,
    pub(super) constant: DVector<f64>,
}

/// A factored system.
pub(super) struct ChainFactor<'a> {
    couplings: &'a [Coupling],
    cliques: Vec<Factored>,
    /// Diagonal blocks of the factor of `BᵀB`.
    diagonal: Vec<Cholesky<f64, Dyn>>,
    /// Blocks below the diagonal.
    below: Vec<DMatrix<f64>>,
}

/// A clique's part: `L`, and `L⁻¹` times the transposed rows that couple it to the clique before and after.
pub(super) struct Factored {
    factor: Cholesky<f64, Dyn>,
    entry: Option<DMatrix<f64>>,
    exit: Option<DMatrix<f64>>,
}

/// A pivot below this share of its diagonal entry is rounding.
const ROUNDING: f64 = 1e-15;
/// What such a pivot becomes, relative to its diagonal entry: nothing moves along it.
const FIXED: f64 = 1e20;

/// The Cholesky factor of a positive semidefinite matrix, of which the lower triangle counts. Directions that
/// rounding hides are fixed.
fn factored(mut matrix: DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let n = matrix.nrows();
    let data = matrix.as_mut_slice();
    let original: Vec<f64> = (0..n).map(|i| data[i * n + i]).collect();
    for j in 0..n {
        let (done, rest) = data.split_at_mut(j * n);
        let column = &mut rest[j..n];
        for k in 0..j {
            let factor = done[k * n + j];
            if factor != 0.0 {
                column.iter_mut().zip(&done[k * n + j..(k + 1) * n]).for_each(|(x, y)| *x -= factor * y);
            }
        }
        let pivot = if column[0] > ROUNDING * original[j] {
            column[0].sqrt()
        } else if original[j] >= 0.0 {
            (FIXED * original[j]).sqrt().max(1.0)
        } else {
            return None;
        };
        if !pivot.is_finite() {
            return None;
        }
        column[0] = pivot;
        column[1..].iter_mut().for_each(|x| *x /= pivot);
    }
    Some(Cholesky::pack_dirty(matrix))
}

impl Factored {
    /// Factors a clique's H, of which the lower triangle counts.
    pub(super) fn new(
        h: &DMatrix<f64>,
        entry: Option<&DMatrix<f64>>,
        exit: Option<&DMatrix<f64>>,
    ) -> Option<Self> {
        let factor = factored(h.clone())?;
        let solved = |rows: &DMatrix<f64>| {
            let mut b = rows.transpose();
            factor.l_dirty().solve_lower_triangular_mut(&mut b);
            b
        };
        let (entry, exit) = (entry.map(solved), exit.map(solved));
        Some(Self { factor, entry, exit })
    }
}

impl<'a> ChainFactor<'a> {
    /// Factors the chain of cliques.
    pub(super) fn new(cliques: Vec<Factored>, couplings: &'a [Coupling]) -> Option<Self> {
        let (mut diagonal, mut below): (Vec<Cholesky<f64, Dyn>>, Vec<DMatrix<f64>>) =
            (Vec::new(), Vec::new());
        for k in 0..couplings.len() {
            let (exit, entry) = (cliques[k].exit.as_ref()?, cliques[k + 1].entry.as_ref()?);
            let mut block = exit.transpose() * exit + entry.transpose() * entry;
            if let Some(last) = diagonal.last() {
                // the clique between two couplings: T = L⁻¹ (entryᵀ exit)
                let mut across = cliques[k].entry.as_ref()?.transpose() * exit;
                last.l_dirty().solve_lower_triangular_mut(&mut across);
                block -= across.transpose() * &across;
                below.push(across);
            }
            diagonal.push(factored(block)?);
        }
        Some(Self { couplings, cliques, diagonal, below })
    }

    /// Solves for the steps of the moments and of the multipliers.
    pub(super) fn solve(
        &self,
        r: &[DVector<f64>],
        s: &[DVector<f64>],
    ) -> (Vec<DVector<f64>>, Vec<DVector<f64>>) {
        let scaled: Vec<DVector<f64>> = self
            .cliques
            .iter()
            .zip(r)
            .map(|(clique, r)| {
                let mut r = r.clone();
                clique.factor.l_dirty().solve_lower_triangular_mut(&mut r);
                r
            })
            .collect();
        let mut lambda: Vec<DVector<f64>> = Vec::new();
        for k in 0..self.couplings.len() {
            let mut right = -&s[k];
            for (part, clique) in [(&self.cliques[k].exit, k), (&self.cliques[k + 1].entry, k + 1)] {
                right += part
                    .as_ref()
                    .map_or_else(|| DVector::zeros(s[k].len()), |part| part.tr_mul(&scaled[clique]));
            }
            if k > 0 {
                right -= self.below[k - 1].tr_mul(&lambda[k - 1]);
            }
            self.diagonal[k].l_dirty().solve_lower_triangular_mut(&mut right);
            lambda.push(right);
        }
        for k in (0..self.couplings.len()).rev() {
            if k + 1 < self.couplings.len() {
                let next = &self.below[k] * &lambda[k + 1];
                lambda[k] -= next;
            }
            self.diagonal[k].l_dirty().tr_solve_lower_triangular_mut(&mut lambda[k]);
        }
        let steps = scaled
            .into_iter()
            .enumerate()
            .map(|(k, mut step)| {
                if let Some(exit) = &self.cliques[k].exit {
                    step -= exit * &lambda[k];
                }
                if let (Some(entry), true) = (&self.cliques[k].entry, k > 0) {
                    step -= entry * &lambda[k - 1];
                }
                self.cliques[k].factor.l_dirty().tr_solve_lower_triangular_mut(&mut step);
                step
            })
            .collect();
        (steps, lambda)
    }
}
