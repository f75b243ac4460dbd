//! An error on unused data with what is predicted of it.

use nalgebra::{DMatrix, DVector};

/// Where an error was found.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub(super) hold: usize,
    pub(super) from_hold: Option<usize>,
    pub(super) start_s: f64,
    pub(super) end_s: f64,
    pub(super) fold: usize,
}

/// An error, and its predicted covariance `own + by_parameters Σ by_parametersᵀ`.
#[derive(Debug, Clone)]
pub(super) struct Item {
    pub(super) place: Place,
    pub(super) error: DVector<f64>,
    /// Derivative of the error with respect to the parameters.
    pub(super) by_parameters: DMatrix<f64>,
    /// What the error owes to itself: noise, and the scatter from hold to hold or from rotation to rotation.
    pub(super) own: DMatrix<f64>,
    /// How much of `own` is that scatter, 0 to 1.
    pub(super) scatter_share: f64,
}

/// Errors that were predicted by one calibration.
pub(super) struct Group {
    pub(super) items: Vec<Item>,
    /// `Σ`.
    pub(super) covariance: DMatrix<f64>,
}

impl Item {
    /// All of its predicted covariance.
    pub(super) fn predicted(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        &self.own + &self.by_parameters * covariance * self.by_parameters.transpose()
    }
}
