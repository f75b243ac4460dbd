//! The problem of the best poses: sensor, number of poses, what is known of their directions, and what they inform of.
//!
//! The covariance that a calibration will state: that of the holds, and that of gravity.
//!
//! An error of gravity is a common factor of the matrix S. It adds `(σ_g/g)² s sᵀ` to the covariance, with s the
//! entries of S among the parameters.

use super::Allowed;
use calibrant_core::information::{Criterion, covariance};
use calibrant_core::json_object;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::{ParameterList, Quantity, SensorParameters};
use nalgebra::{DMatrix, DVector, Vector3};

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

/// The covariance with that of gravity added.
pub(super) fn with_gravity(problem: &PoseProblem, of_holds: DMatrix<f64>) -> DMatrix<f64> {
    let slope = gravity_slope(problem);
    of_holds + &slope * slope.transpose()
}

impl PoseProblem {
    /// Did somebody give gravity? It is not known better than on the Earth's surface otherwise.
    #[must_use]
    pub fn gravity_is_given(&self) -> bool {
        self.nuisance.gravity_sd_mps2 < Gravity::SOMEWHERE.sd_mps2
    }

    /// Standard deviations without the part of gravity, which no pose changes.
    #[must_use]
    pub fn sd_beside_gravity(&self, covariance: &DMatrix<f64>) -> DVector<f64> {
        covariance
            .diagonal()
            .zip_map(&gravity_slope(self), |variance, gravity| (variance - gravity * gravity).max(0.0).sqrt())
    }

    /// The covariance before the poses, where all parameters are known: that of the prior, with gravity.
    #[must_use]
    pub fn covariance_before(&self) -> Option<DMatrix<f64>> {
        self.prior.as_ref().and_then(covariance).map(|of_prior| with_gravity(self, of_prior))
    }

    /// The problem with a prior that came from a calibration which assumed this gravity. The error of gravity is
    /// taken out of the prior's covariance, since it is added to that of the result.
    #[must_use]
    pub fn with_gravity_out_of_prior(mut self) -> Self {
        let slope = gravity_slope(&self);
        let without =
            self.prior.as_ref().and_then(covariance).map(|of_prior| of_prior - &slope * slope.transpose());
        // a prior that knew gravity better stays
        if let Some(information) = without.as_ref().and_then(covariance) {
            self.prior = Some(information);
        }
        self
    }
}

/// The change of each parameter for one standard deviation of gravity.
pub(super) fn gravity_slope(problem: &PoseProblem) -> DVector<f64> {
    let share = problem.nuisance.gravity_sd_mps2 / problem.gravity_mps2;
    let change = |quantity: &Quantity| match quantity {
        Quantity::Bias(_) => 0.0,
        // forces that grow by a share lessen S by it, and (m/s²)¹⁻ᵖ by p − 1 times it
        Quantity::Nonlinear(term, _) => share * f64::from(term.power() - 1) * quantity.value(&problem.at),
        _ => share * quantity.value(&problem.at),
    };
    DVector::from_iterator(problem.list.len(), problem.list.quantities().iter().map(change))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::DirectionKnowledge;
    use crate::poses::tests::problem;

    #[test]
    fn gravity_leaves_the_prior_and_comes_back() {
        let mut problem = problem(DirectionKnowledge::Unknown, 12);
        problem.nuisance.gravity_sd_mps2 = 4e-4;
        let of_holds = DMatrix::from_fn(9, 9, |i, j| if i == j { 1e-8 } else { 1e-10 });
        let with = with_gravity(&problem, of_holds.clone());
        assert!((with[(3, 3)] - 1e-8 - (4e-4_f64 / 9.80665).powi(2)).abs() < 1e-20, "{with}");
        assert_eq!(with[(0, 0)], of_holds[(0, 0)]);
        problem.prior = covariance(&with);
        let problem = problem.with_gravity_out_of_prior();
        let left = problem.prior.as_ref().and_then(covariance).expect("regular");
        assert!((left - of_holds).amax() < 1e-16);
        assert!((problem.covariance_before().expect("a prior") - with).amax() < 1e-16);
    }
}
