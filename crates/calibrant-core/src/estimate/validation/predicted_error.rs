//! An error on unused data with what is predicted of it.

use nalgebra::{DMatrix, DVector, Vector3};

/// Directions closer than this are one orientation, rad.
const SAME_ORIENTATION_RAD: f64 = 0.17;

/// Where an error was found.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub(super) hold: usize,
    pub(super) from_hold: Option<usize>,
    pub(super) start_s: f64,
    pub(super) end_s: f64,
    pub(super) fold: usize,
    /// Directions of the specific force: of the hold, or of the one before a rotation and of the one after.
    pub(super) along: Vec<Vector3<f64>>,
}

impl Place {
    /// Is it the same orientation, or rotation?
    pub(super) fn is_oriented_as(&self, other: &Self) -> bool {
        self.along.len() == other.along.len()
            && self.along.iter().zip(&other.along).all(|(a, b)| a.angle(b) < SAME_ORIENTATION_RAD)
    }
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
    /// Share of knocks in `own`, whose errors follow Student's distribution.
    pub(super) knock_share: f64,
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

impl Group {
    /// Leaves out items. What follows one of them has no neighbour before it.
    pub(super) fn retain(&mut self, keep: impl Fn(&Place) -> bool) {
        let mut is_after_one = false;
        for item in &mut self.items {
            if is_after_one {
                item.with_previous = None;
            }
            is_after_one = !keep(&item.place);
        }
        self.items.retain(|item| keep(&item.place));
    }
}

impl Item {
    /// Share of the scatter between holds or rotations in what the error owes to itself.
    pub(super) fn scatter_share(&self) -> f64 {
        let shares = self.scatters.iter().map(|part| part.scatter / part.own);
        shares.sum::<f64>() / self.scatters.len().max(1) as f64
    }

    /// All of its predicted covariance.
    pub(super) fn predicted(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        &self.own + &self.by_parameters * covariance * self.by_parameters.transpose()
    }
}
