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
    /// Covariance of `own` errors with those of the item before; `None` where they have nothing in common.
    pub(super) with_previous: Option<DMatrix<f64>>,
    /// For each scatter of the calibration: what its data told of the variance, noise included, over `own`; 0 where they showed no scatter.
    pub(super) estimated_shares: Vec<f64>,
}

/// The share of a variance that was estimated: what is not noise, and noise as it was in the calibration, which is so many times what it is here.
pub(super) fn estimated_share(noise: f64, own: f64, more_noise: f64) -> f64 {
    if own > noise { (own - noise + more_noise * noise) / own } else { 0.0 }
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
