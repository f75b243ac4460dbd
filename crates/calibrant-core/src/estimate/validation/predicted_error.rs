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
    /// For each scatter of the calibration, what of a component's variance it tells.
    pub(super) scatters: Vec<Scattered>,
}

/// Parts of a variance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scattered {
    /// The scatter that the calibration found.
    pub(super) scatter: f64,
    /// What the noise would be in the calibration, which told the scatter from it.
    pub(super) calibrated_noise: f64,
    /// All of it.
    pub(super) own: f64,
}

impl Scattered {
    /// What the calibration's data told of the variance, noise included, over all of it; 0 where they showed no scatter.
    pub(super) fn estimated_share(&self) -> f64 {
        if self.scatter > 0.0 { (self.scatter + self.calibrated_noise) / self.own } else { 0.0 }
    }
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
