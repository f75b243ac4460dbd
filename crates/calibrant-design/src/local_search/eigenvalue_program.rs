//! The convex program of one iteration for criterion E: the largest smallest eigenvalue of the linearised information.
//!
//! The linearised information is a lower bound of the information, so this is a convex upper bound of the criterion
//! ([`crate::local_search::long_program`]). It is minimised exactly: `maximise t: F_lin ⪰ t diag(s)⁻²`, with s the divisors of the
//! parameters. With `S F S = L Lᵀ` at the motion and λ its smallest eigenvalue, the program has the matrix
//! `L⁻¹ S F_lin S L⁻ᵀ`, the identity at the motion, and the metric `λ L⁻¹ L⁻ᵀ`: so t is 1 at the motion, and parameters of
//! different size do no harm.
//!
//! # References
//! `boyd2004`, `pukelsheim2006`

use super::{Nodes, Part, Rounds};
use crate::convex::{AffineMatrix, ChainProgram};
use calibrant_core::information::Criterion;
use nalgebra::{DMatrix, SMatrix, SVector};

/// What one iteration leaves for the next.
pub(crate) struct EigenvalueProgram<const D: usize>(Rounds<D>);

impl<const D: usize> EigenvalueProgram<D> {
    pub(crate) fn new() -> Self {
        Self(Rounds::new())
    }

    /// The admissible motion that minimises the bound, and what it promises: the growth of the smallest eigenvalue.
    pub(crate) fn step<const P: usize>(
        &mut self,
        part: &Part<D, P>,
        a: &[SVector<f64, D>],
    ) -> Option<(Nodes<D>, f64)> {
        let model = part.relative_information(a)?;
        let program = |peaks: &_| {
            let chains = part.regions.iter().zip(peaks).map(|(region, peaks)| region.chain(peaks)).collect();
            ChainProgram { chains, forms: Vec::new(), matrix: Some(model.clone()), reached: -1.0 }
        };
        self.0.solve(part, a, program, |_| ())
    }
}

impl<const D: usize, const P: usize> Part<D, P> {
    /// The linearised information around a motion, relative to that of the motion.
    fn relative_information(&self, a: &[SVector<f64, D>]) -> Option<AffineMatrix> {
        let Criterion::E(e) = &self.criterion else { return None };
        let at = self.information.linearise(a)?;
        let scaled = |f: &SMatrix<f64, P, P>| {
            DMatrix::from_fn(P, P, |i, j| 0.5 * (f[(i, j)] + f[(j, i)]) * e.scale[i] * e.scale[j])
        };
        let here = scaled(&self.inverse_covariance(&at));
        let smallest = 1.0 / self.criterion.value(&self.covariance(&at)?);
        let root = here.cholesky()?.unpack().solve_lower_triangular(&DMatrix::identity(P, P))?;
        let signs: Vec<_> = a.windows(2).map(|pair| (pair[1] - pair[0]).map(f64::signum)).collect();
        let changes = self.information.first_derivatives(a, &at, &signs);
        let of = |i: usize, k: usize| {
            let change = scaled(&self.on_inverse_covariance(&changes[i * D + k]));
            &root * change * root.transpose() * self.regions[k].size
        };
        Some(AffineMatrix {
            constant: DMatrix::identity(P, P),
            changes: (0..D).map(|k| (0..a.len()).map(|i| of(i, k)).collect()).collect(),
            around: (0..D).map(|k| a.iter().map(|a| a[k] / self.regions[k].size).collect()).collect(),
            metric: &root * root.transpose() * smallest,
        })
    }
}

#[cfg(test)]
#[path = "eigenvalue_program_tests.rs"]
mod tests;
