//! The fewest poses with which parameters are determined well enough.
//!
//! Where the goals are reached, a sum of variances with weights 1/goal² is at most the number of goals. Such a sum
//! is criterion c. Its bound for n poses bounds the sum that any n poses give, whatever the criterion of the
//! design. A further pose never adds to a variance, so that the numbers that are too small are those below one
//! number. That number is found by bisection, for each goal alone and for all together.
//!
//! The number that suffices is found from designs by the criterion of the problem. The variances of the holds
//! fall about as 1/n, which gives the next n to try, at most twice as many; bisection then ends the search. A drift and the grid of
//! n make the variances of designs not quite monotone, so that a smaller number may do: the bound says from
//! where on.

use super::enough::{enough, singular};
use super::hold_information::HoldInformation;
use super::problem::{PoseProblem, gravity_slope};
use super::result::PoseDesign;
use super::search::{design_poses, relaxed};
use crate::DesignSettings;
use crate::problem::{Goal, first_that_passes};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::information::Criterion;
use calibrant_core::information::criterion::COptimality;
use nalgebra::{DMatrix, DVector};

/// Most poses that are considered.
pub(super) const MOST: usize = 200;

/// The fewest poses found that reach the goals, and a number that any set needs.
#[derive(Debug, Clone, PartialEq)]
pub struct FewestPoses {
    /// The design with the fewest poses.
    pub design: PoseDesign,
    /// No set of fewer allowed poses reaches the goals.
    pub at_least: usize,
}

/// The best poses by the criterion of the problem, as few as reach the goals.
///
/// # Errors
/// As [`design_poses`]. [`Error::Experiment`] where the goals need more than 200 poses, or the uncertainty of
/// gravity alone exceeds one.
pub fn fewest_poses(
    problem: &PoseProblem,
    goals: &[Goal],
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<FewestPoses> {
    let information = HoldInformation::new(problem).ok_or_else(singular)?;
    let enough = enough(problem, &information)?;
    let limits = variances_of_holds(problem, goals)?;
    let questions = questions(&limits, problem.list.len());
    let possible = |poses: usize| -> Result<bool> {
        Ok(questions
            .iter()
            .all(|weights| least_sum(problem, &information, weights, poses, settings.seed) <= 1.0))
    };
    if !possible(MOST)? {
        let message = format!(
            "by the bound, more than {MOST} poses are needed to reach the standard deviations asked for"
        );
        let help = "hold longer (holds.hold_s), or ask for less";
        return Err(Error::experiment(InputError::new(Refusal::ValueOutOfRange, message, help)));
    }
    let at_least = first_that_passes(0, MOST, possible)?.max(enough.at_least);
    let slope = gravity_slope(problem);
    let mut best: Option<PoseDesign> = None;
    let mut used = |poses: usize| -> Result<f64> {
        let design = match design_poses(&PoseProblem { poses, ..problem.clone() }, settings, progress) {
            // this many were not found to determine all
            Err(Error::NotIdentifiable(_)) => return Ok(f64::INFINITY),
            other => other?,
        };
        let used = largest_use(&limits, &design.covariance, &slope);
        if used <= 1.0 && best.as_ref().is_none_or(|best| best.directions.len() > poses) {
            best = Some(design);
        }
        Ok(used)
    };
    let (mut low, mut high) = (at_least - 1, at_least.max(enough.set.len()));
    loop {
        let needed = used(high)?;
        if needed <= 1.0 {
            break;
        }
        if high >= MOST {
            return Err(by_this_criterion());
        }
        low = high;
        // hardly enough poses determine little, and say nothing of how many more are needed
        high = ((high as f64 * needed.min(2.0)).ceil() as usize).clamp(high + 1, MOST);
    }
    first_that_passes(low, high, |poses| used(poses).map(|used| used <= 1.0))?;
    let design = best.ok_or_else(singular)?;
    Ok(FewestPoses { design, at_least })
}

/// Each goal's parameter, with the variance that is left to the holds beside that of gravity. Where nobody gave gravity, the goals are those of the
/// holds alone.
fn variances_of_holds(problem: &PoseProblem, goals: &[Goal]) -> Result<Vec<(usize, f64)>> {
    let slope = gravity_slope(problem);
    let of = |goal: &Goal| {
        let gravity = slope[goal.parameter].abs();
        let of_gravity = if problem.gravity_is_given() { gravity * gravity } else { 0.0 };
        let left = goal.sd * goal.sd - of_gravity;
        if left > 0.0 {
            return Ok((goal.parameter, left));
        }
        let name = &problem.list.names()[goal.parameter];
        let message =
            format!("the uncertainty of gravity alone gives {name} a standard deviation of {gravity:.2e}");
        let help = "measure gravity (holds.gravity_mps2, holds.gravity_sd_mps2), or ask for less";
        Err(Error::experiment(InputError::new(Refusal::ValueOutOfRange, message, help)))
    };
    goals.iter().map(of).collect()
}

/// Weights with which a weighted sum of variances is at most 1 where the limits are kept: for each limit alone,
/// and for all together.
fn questions(limits: &[(usize, f64)], parameters: usize) -> Vec<DVector<f64>> {
    let alone = |&(parameter, most): &(usize, f64)| {
        let mut weights = DVector::zeros(parameters);
        weights[parameter] = 1.0 / most;
        weights
    };
    let mut all: Vec<DVector<f64>> = limits.iter().map(alone).collect();
    if all.len() > 1 {
        all.push(all.iter().sum::<DVector<f64>>() / all.len() as f64);
    }
    all
}

/// No n allowed poses give a smaller sum of variances with these weights.
fn least_sum(
    problem: &PoseProblem,
    information: &HoldInformation,
    weights: &DVector<f64>,
    poses: usize,
    seed: u64,
) -> f64 {
    let criterion = Criterion::C(COptimality { weights: weights.clone() });
    let alone = PoseProblem { criterion, poses, ..problem.clone() };
    // the best directions for one parameter may leave others undetermined, where there is no bound
    relaxed(&alone, information, seed).map_or(0.0, |found| found.bound.max(0.0))
}

/// Largest share of a limit that the variances of the holds use.
fn largest_use(limits: &[(usize, f64)], covariance: &DMatrix<f64>, gravity: &DVector<f64>) -> f64 {
    let used = |&(k, most): &(usize, f64)| (covariance[(k, k)] - gravity[k] * gravity[k]) / most;
    limits.iter().map(used).fold(0.0, f64::max)
}

fn by_this_criterion() -> Error {
    let message = format!(
        "the best {MOST} poses found by this criterion do not reach the standard deviations asked for"
    );
    let help =
        "choose criterion c with weights on these parameters, hold longer (holds.hold_s), or ask for less";
    Error::experiment(InputError::new(Refusal::ValueOutOfRange, message, help))
}
