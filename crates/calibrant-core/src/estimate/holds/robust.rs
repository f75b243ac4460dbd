//! What the robust fit of the holds takes and gives.

use crate::estimate::CalibrationStatus;
use crate::sensor::SensorParameters;
use crate::solve::Uncertainty;
use nalgebra::{DMatrix, DVector, Vector3};

/// What the robust fit gives. Vectors have one entry for each hold, used or not.
pub(super) struct Robust {
    pub(super) sensor: SensorParameters,
    pub(super) forces: Vec<Vector3<f64>>,
    pub(super) magnitudes: Vec<Magnitude>,
    pub(super) studentised: Vec<f64>,
    pub(super) used: Vec<bool>,
    pub(super) covariance: DMatrix<f64>,
    /// Inverse variances of the prior, where there is one.
    pub(super) prior_weight: Option<DVector<f64>>,
    pub(super) chi2: f64,
    pub(super) degrees_of_freedom: usize,
    /// Pooled scatter of samples within holds, unit of the readings.
    pub(super) within_sd: Vector3<f64>,
    /// `σ_b`, m/s².
    pub(super) between_holds_sd: f64,
    pub(super) condition_number: f64,
    /// The combination that is determined worst: parameter names and their shares.
    pub(super) weakest: Vec<String>,
    pub(super) status: CalibrationStatus,
    pub(super) iterations: usize,
    pub(super) gradient_norm: f64,
}

impl Robust {
    /// The uncertainty of the parameters, before what all holds share.
    pub(super) fn uncertainty(&self) -> Uncertainty {
        Uncertainty::of(self.covariance.clone(), self.prior_weight.as_ref().map(DVector::as_slice))
    }
}

/// The magnitude of a corrected hold less gravity.
pub(super) struct Magnitude {
    /// m/s²
    pub(super) error: f64,
    /// Its variance by noise and scatter of the hold itself.
    pub(super) own: f64,
    /// Direction of the corrected force.
    pub(super) along: Vector3<f64>,
    /// Derivative of the magnitude that the fit leaves with respect to the parameters, up to its sign.
    pub(super) by_parameters: DVector<f64>,
}

/// What a drift of the bias means for the weights.
#[derive(Debug, Clone, Default)]
pub(super) struct Conditions {
    /// The holds that are used; `None` to find the outliers.
    pub(super) used: Option<Vec<bool>>,
    /// Degrees of freedom that it takes.
    pub(super) taken: f64,
    /// Least `σ_b`, m/s².
    pub(super) least_between: f64,
}
