//! The result of the search for the best poses.

use super::efficiency::efficiency;
use super::usual::UsualPoses;
use calibrant_core::information::Criterion;
use calibrant_core::json_object;
use nalgebra::{DMatrix, DVector, Vector3};

/// The best poses that were found, and how near they are to the best possible.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseDesign {
    /// Direction of the specific force (up) in each pose, unit vectors in the sensor's axes, in the order in
    /// which they should be taken.
    pub directions: Vec<Vector3<f64>>,
    /// The covariance that a calibration will state, p × p: that of the holds, with gravity and a drift.
    pub covariance: DMatrix<f64>,
    /// The criterion of the holds alone. Gravity adds the same to every set, and a drift depends on the order.
    pub value: f64,
    /// The bound that no set of as many poses can beat.
    pub bound: PoseBound,
    /// Poses that an engineer would take without a design, where the problem allows them.
    pub usual: Vec<UsualPoses>,
    /// Number of starts of the search, and of those that ended within 0.1 % of the best.
    pub starts: usize,
    /// See `starts`.
    pub starts_at_best: usize,
    /// Was the search ended early?
    pub interrupted: bool,
}

impl PoseDesign {
    /// Standard deviations of the parameters, each in its own unit.
    #[must_use]
    pub fn sd(&self) -> DVector<f64> {
        self.covariance.diagonal().map(f64::sqrt)
    }
}

/// A lower bound of the criterion, and the approximate design that gives it.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseBound {
    /// No set of as many allowed poses has a lower value.
    pub value: f64,
    /// Directions of the approximate design.
    pub directions: Vec<Vector3<f64>>,
    /// Share of the poses at each of them; their sum is one.
    pub shares: Vec<f64>,
}

json_object! {
    /// A lower bound of the criterion, and the approximate design that gives it.
    PoseBound as of {
        /// No set of as many allowed poses has a lower value.
        lower_bound: of.value,
        /// Directions of the approximate design.
        directions: of.directions.iter().map(|up| <[f64; 3]>::from(*up)).collect::<Vec<_>>(),
        /// Share of the poses at each direction.
        shares: &of.shares,
    }
}

impl PoseBound {
    /// How efficient poses with this value of the criterion are, from 0 to 1, for a number of parameters.
    #[must_use]
    pub fn efficiency_of(&self, criterion: &Criterion, value: f64, parameters: usize) -> f64 {
        efficiency(criterion, value, self.value, parameters)
    }
}

impl PoseDesign {
    /// The efficiency against the bound, from 0 to 1: at least this share of the best possible.
    #[must_use]
    pub fn efficiency(&self, criterion: &Criterion) -> f64 {
        efficiency(criterion, self.value, self.bound.value, self.covariance.nrows())
    }
}
