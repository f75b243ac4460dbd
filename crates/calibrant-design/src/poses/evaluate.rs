//! The information of given poses, against the best possible.

use super::Allowed;
use super::efficiency::efficiency;
use super::enough::{named, singular};
use super::hold_information::HoldInformation;
use super::order::Drift;
use super::problem::{PoseProblem, with_gravity};
use super::result::PoseBound;
use super::search::relaxed;
use super::spectral_projected_gradient::Poses;
use calibrant_core::error::{Error, NotIdentifiable, Result};
use calibrant_core::information::{covariance, undetermined};
use nalgebra::{DMatrix, DVector, Vector3};

/// Given poses, and how near they are to the best possible.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseEvaluation {
    /// The covariance that a calibration will state, p × p: that of the holds, with gravity and a drift.
    pub covariance: DMatrix<f64>,
    /// The criterion of the holds alone.
    pub value: f64,
    /// The bound for as many poses in any directions.
    pub bound: PoseBound,
    /// From 0 to 1: at least this share of the best possible.
    pub efficiency: f64,
}

impl PoseEvaluation {
    /// Standard deviations of the parameters, each in its own unit.
    #[must_use]
    pub fn sd(&self) -> DVector<f64> {
        self.covariance.diagonal().map(f64::sqrt)
    }
}

/// The covariance that the holds alone give, p × p: without gravity and a drift. `None` where they leave
/// parameters undetermined. Directions as for [`evaluate_poses`].
#[must_use]
pub fn covariance_of_holds(problem: &PoseProblem, directions: &[Vector3<f64>]) -> Option<DMatrix<f64>> {
    let information = HoldInformation::new(problem)?;
    let sum = information.sum(directions.iter().map(|u| (u, 1.0)));
    let f = information.of_parameters(&sum);
    if undetermined(&f, &f.diagonal(), 0).is_empty() { covariance(&f) } else { None }
}

/// How much each hold tells, as a share of what all tell: `tr(m(u_j) C) / Σ_k tr(m(u_k) C)` with the covariance `C` of [`covariance_of_holds`].
#[must_use]
pub fn shares_of_holds(
    problem: &PoseProblem,
    directions: &[Vector3<f64>],
    covariance: &DMatrix<f64>,
) -> Option<Vec<f64>> {
    let information = HoldInformation::new(problem)?;
    let told: Vec<f64> = directions.iter().map(|u| information.of_hold(u).dot(covariance)).collect();
    let all: f64 = told.iter().sum();
    Some(told.into_iter().map(|one| one / all).collect())
}

/// The information of these poses, given as directions of the specific force (up) in the sensor's axes, in the
/// order in which they were taken. They are compared with as many in any directions. All count the same.
///
/// # Errors
/// [`Error::NotIdentifiable`] where they leave parameters undetermined.
pub fn evaluate_poses(
    problem: &PoseProblem,
    directions: &[Vector3<f64>],
    seed: u64,
) -> Result<PoseEvaluation> {
    let problem = PoseProblem { poses: directions.len(), allowed: Allowed::Anywhere, ..problem.clone() };
    let information = HoldInformation::new(&problem).ok_or_else(singular)?;
    let poses = Poses::equal(directions.iter().map(Vector3::normalize).collect());
    let sum = information.sum(poses.directions.iter().map(|u| (u, 1.0)));
    let f = information.of_parameters(&sum);
    let names = problem.list.names();
    let reason = format!("the directions of the {} holds are too few or too similar", directions.len());
    let groups =
        named(&undetermined(&f, &f.diagonal(), 0), &names, &reason, "hold the sensor in more directions");
    if !groups.is_empty() {
        return Err(Error::NotIdentifiable(Box::new(NotIdentifiable { groups })));
    }
    let without = poses.covariance(&information).ok_or_else(singular)?;
    let value = problem.criterion.value(&without);
    let drift = Drift::of(&information, &poses.directions, without, &problem.nuisance.drift_sd);
    let order: Vec<usize> = (0..directions.len()).collect();
    let covariance = with_gravity(&problem, drift.covariance(&order));
    let bound = relaxed(&problem, &information, seed).ok_or_else(singular)?.bound_of(value);
    let efficiency = efficiency(&problem.criterion, value, bound.value, names.len());
    Ok(PoseEvaluation { covariance, value, bound, efficiency })
}
