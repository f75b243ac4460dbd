//! The problem of the best poses: sensor, number of poses, what is known of their directions.

use super::Allowed;
use calibrant_core::information::Criterion;
use calibrant_core::json_object;
use calibrant_core::sensor::{ParameterList, SensorParameters};
use nalgebra::{DMatrix, Vector3};

/// What is known of the directions of the holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DirectionKnowledge {
    /// Nothing but `|f| = g`.
    Unknown,
    /// They are known with a standard deviation, rad about each axis across them; 0 for exactly.
    Known {
        /// The standard deviation, rad.
        sd_rad: f64,
    },
}

impl DirectionKnowledge {
    /// As written in files: `unknown`, `known`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Unknown => "unknown",
            Self::Known { .. } => "known",
        }
    }

    /// Their standard deviation, rad, where they are known.
    #[must_use]
    pub fn sd_rad(self) -> Option<f64> {
        match self {
            Self::Unknown => None,
            Self::Known { sd_rad } => Some(sd_rad),
        }
    }
}

/// Find the n directions whose holds determine the parameters best:
///
/// `minimise over u₁ … u_n: Φ(C)`, `C = (M₀ + Σ m(u_k))⁻¹`.
#[derive(Debug, Clone)]
pub struct PoseProblem {
    /// The parameters: those of the gauge where the directions are unknown (9 or 6), or all (12 or 6).
    pub list: ParameterList,
    /// The sensor at which the information is taken: nominal, or the last calibration.
    pub at: SensorParameters,
    /// Gravity, m/s².
    pub gravity_mps2: f64,
    /// Standard deviation of the mean reading of one hold, per axis, in the unit of the readings.
    pub mean_sd: Vector3<f64>,
    /// What is known of the directions.
    pub directions: DirectionKnowledge,
    /// The directions that a pose may have.
    pub allowed: Allowed,
    /// The criterion that is minimised.
    pub criterion: Criterion,
    /// Information that is there already, p × p in the order of `list`: a prior, or earlier holds.
    pub prior: Option<DMatrix<f64>>,
    /// Number of poses n.
    pub poses: usize,
    /// What the calibration allows for beside the holds.
    pub nuisance: PoseNuisance,
}

json_object! {
    /// The conditions of the calibration.
    PoseProblem as of {
        gravity_mps2: of.gravity_mps2,
        /// Standard deviation of the mean reading of one hold, in the unit of the readings.
        mean_sd: <[f64; 3]>::from(of.mean_sd),
        /// What is known of the directions of the holds: `unknown`, `known`.
        directions: of.directions.name(),
        direction_sd_rad: of.directions.sd_rad(),
        /// Was there information before?
        has_prior: of.prior.is_some(),
        gravity_sd_mps2: of.nuisance.gravity_sd_mps2,
        /// Standard deviation of the drift of each bias from the first pose to the last.
        bias_drift_sd: <[f64; 3]>::from(of.nuisance.drift_sd),
    }
}

/// What adds to the standard deviations of a calibration, and is the same for all sets of poses or depends on
/// their order alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseNuisance {
    /// Standard uncertainty of gravity, m/s².
    pub gravity_sd_mps2: f64,
    /// Standard deviation of the drift of each bias from the first pose to the last, in the unit of the
    /// readings; 0 for none.
    pub drift_sd: Vector3<f64>,
    /// Shall the turns between the poses determine a gyroscope?
    pub has_gyroscope: bool,
}

impl PoseNuisance {
    /// Nothing.
    #[must_use]
    pub fn none() -> Self {
        Self { gravity_sd_mps2: 0.0, drift_sd: Vector3::zeros(), has_gyroscope: false }
    }
}
