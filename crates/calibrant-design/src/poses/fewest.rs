//! The fewest poses with which parameters are determined well enough.

use super::hold_information::HoldInformation;
use super::problem::PoseProblem;
use super::result::PoseDesign;
use super::search::{design_poses, fewest_that_determine, relaxed, singular};
use crate::DesignSettings;
use crate::goal::{Goal, first_that_passes};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::information::Criterion;
use calibrant_core::information::criterion::COptimality;
use nalgebra::DVector;

/// Most poses that are considered.
const MOST: usize = 200;

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
/// The lower bound of a variance is that of criterion c with this variance alone.
///
/// # Errors
/// As [`design_poses`]. [`Error::Experiment`] where the goals need more than 200 poses.
pub fn fewest_poses(
    problem: &PoseProblem,
    goals: &[Goal],
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<FewestPoses> {
    let information = HoldInformation::new(problem).ok_or_else(singular)?;
    let fewest = fewest_that_determine(problem, &information, settings.seed)?;
    let bounded = |poses: usize| -> Result<bool> {
        let mut worst = 0.0_f64;
        for goal in goals {
            let mut weights = DVector::zeros(problem.list.len());
            weights[goal.parameter] = 1.0;
            let criterion = Criterion::C(COptimality { weights });
            let alone = PoseProblem { criterion, poses, ..problem.clone() };
            // directions that do not determine the other parameters are no start
            let variance = relaxed(&alone, &information, settings.seed).map_or(0.0, |found| found.bound);
            worst = worst.max(variance.max(0.0).sqrt() / goal.sd);
        }
        Ok(worst <= 1.0)
    };
    if !bounded(MOST)? {
        let message = format!("more than {MOST} poses are needed to reach the standard deviations asked for");
        let help = "hold longer (holds.hold_s), or ask for less";
        return Err(Error::experiment(InputError::new(Refusal::ValueOutOfRange, message, help)));
    }
    let at_least = first_that_passes(0, MOST, bounded)?.max(fewest);
    let mut best: Option<PoseDesign> = None;
    let mut reached = |poses: usize| -> Result<f64> {
        let design = design_poses(&PoseProblem { poses, ..problem.clone() }, settings, progress)?;
        let sd = design.sd();
        let worst = Goal::worst(goals, |parameter| sd[parameter]);
        if worst <= 1.0 && best.as_ref().is_none_or(|best| best.directions.len() > poses) {
            best = Some(design);
        }
        Ok(worst)
    };
    // variances fall about as 1/n
    let (mut low, mut high) = (at_least - 1, at_least);
    loop {
        let worst = reached(high)?;
        if worst <= 1.0 {
            break;
        }
        if high >= MOST {
            let message =
                format!("{MOST} poses by this criterion do not reach the standard deviations asked for");
            let help = "choose criterion c with weights on these parameters, hold longer (holds.hold_s), or ask for less";
            return Err(Error::experiment(InputError::new(Refusal::ValueOutOfRange, message, help)));
        }
        low = high;
        let needed = (high as f64 * worst * worst).ceil();
        high = (needed as usize).clamp(high + 1, MOST);
    }
    first_that_passes(low, high, |poses| reached(poses).map(|worst| worst <= 1.0))?;
    let design = best.ok_or_else(singular)?;
    Ok(FewestPoses { design, at_least })
}
