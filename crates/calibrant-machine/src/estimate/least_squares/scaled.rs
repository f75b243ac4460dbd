//! Information matrices of parameters in unlike units, scaled to a unit diagonal before they are factored.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// A factored information matrix.
pub(crate) struct Scaled {
    factor: Cholesky<f64, Dyn>,
    scale: DVector<f64>,
}

impl Scaled {
    /// `None` where it is not positive definite.
    pub(crate) fn new(information: &DMatrix<f64>) -> Option<Self> {
        let scale = information.diagonal().map(|d| if d > 0.0 { d.sqrt().recip() } else { 1.0 });
        let scaled = information.component_mul(&(&scale * scale.transpose()));
        Some(Self { factor: Cholesky::new(scaled)?, scale })
    }

    pub(crate) fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        self.factor.solve(&right.component_mul(&self.scale)).component_mul(&self.scale)
    }

    pub(crate) fn inverse(&self) -> DMatrix<f64> {
        self.factor.inverse().component_mul(&(&self.scale * self.scale.transpose()))
    }
}
