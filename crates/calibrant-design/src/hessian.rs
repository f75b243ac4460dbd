//! The exact second derivative of the criterion, where the model of [`super::criterion_model`] is a poor one.
//!
//! Noise in proportion to the jerk takes back what a larger jerk gains: the bend of the information and that
//! of the noise nearly cancel. A model with only one of them makes steps a hundred times too short. So for a
//! noisy motion the Hessian comes from central differences of the exact gradient, and its positive part is
//! the model's bend. That costs a gradient for each node. So it is done for motions of up to [`LARGEST`]
//! unknowns; longer ones use the model, more slowly.

use super::part::{Nodes, Part};
use nalgebra::{DMatrix, DVector, SMatrix, SVector};

/// Largest number of unknowns for which the Hessian is formed.
pub(super) const LARGEST: usize = 90;
/// Step of the differences, in units of the motion's size.
const STEP: f64 = 1e-5;
/// Relative size of an eigenvalue that counts as zero.
const ZERO_EIGENVALUE: f64 = 1e-9;

impl<const D: usize, const P: usize> Part<D, P> {
    /// The gradient of the criterion; `None` where the motion does not determine the parameters.
    pub(super) fn gradient(&self, a: &[SVector<f64, D>]) -> Option<Nodes<D>> {
        let at = self.information.linearise(a)?;
        let c = self.covariance(&at)?;
        let first = &c * self.criterion.derivative(&c) * &c;
        let omega = SMatrix::from_fn(|i, j| first[(i, j)]);
        let total = self.information.total(a, &self.information.derivative(&at, &omega));
        Some(total.into_iter().map(|slope| -slope).collect())
    }

    /// Forms whose squares add up to twice the positive part of the criterion's second-order term.
    pub(super) fn positive_curvature(&self, a: &[SVector<f64, D>]) -> Option<Vec<Nodes<D>>> {
        let unknowns = a.len() * D;
        let flat = |nodes: Nodes<D>| DVector::from_fn(unknowns, |at, _| nodes[at / D][at % D]);
        let mut hessian = DMatrix::zeros(unknowns, unknowns);
        for at in 0..unknowns {
            let step = STEP * self.regions[at % D].size;
            let moved = |by: f64| {
                let mut moved = a.to_vec();
                moved[at / D][at % D] += by;
                self.gradient(&moved).map(flat)
            };
            hessian.set_column(at, &((moved(step)? - moved(-step)?) / (2.0 * step)));
        }
        let eigen = ((&hessian + hessian.transpose()) * 0.5).symmetric_eigen();
        let largest = eigen.eigenvalues.amax();
        let forms = (0..unknowns).filter(|&k| eigen.eigenvalues[k] > ZERO_EIGENVALUE * largest).map(|k| {
            let row = eigen.eigenvectors.column(k) * eigen.eigenvalues[k].sqrt();
            (0..a.len()).map(|i| SVector::from_fn(|d, _| row[i * D + d])).collect()
        });
        Some(forms.collect())
    }
}
