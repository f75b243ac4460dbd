//! What a given motion will tell.

use super::{DesignProblem, Evaluation};
use crate::error::{Result, UndeterminedGroup};
use crate::information::{covariance, undetermined};
use crate::motion::JerkControlledMotion;

/// Predicts the covariance of a calibration from a recording of `motion`. Intervals and limits of the problem are not used.
///
/// # Errors
/// As [`MotionInformation::of`](crate::information::MotionInformation::of). A motion that leaves parameters undetermined is not an error: the result says which.
pub fn evaluate(problem: &DesignProblem<'_>, motion: &JerkControlledMotion) -> Result<Evaluation> {
    let mut information = problem.setting()?.of(motion)?;
    if let Some(prior) = &problem.prior {
        information += prior;
    }
    let groups = undetermined(&information, &information.diagonal());
    let c = if groups.is_empty() { covariance(&information) } else { None };
    let names = problem.sensor.parameter_list().names();
    Ok(Evaluation {
        motion: motion.clone(),
        value: c.as_ref().map_or(f64::INFINITY, |c| problem.criterion.value(c)),
        information,
        covariance: c,
        undetermined: groups
            .into_iter()
            .map(|group| UndeterminedGroup {
                parameters: group.parameters.iter().map(|&place| names[place].clone()).collect(),
                free_combinations: group.free_combinations,
                reason: "the motion does not tell them apart".into(),
                remedy: "move these axes more, and differently".into(),
            })
            .collect(),
    })
}
