//! Design: the motion whose recording determines the parameters best, and the proof of how good it is.

mod certificate;
mod conic;
mod curvature;
mod evaluate;
mod local;
mod problem;
mod region;
mod result;
mod search;
mod settings;
mod starts;

pub use evaluate::evaluate;
pub use problem::DesignProblem;
pub use result::{Certificate, Design, DesignStatus, Evaluation, StartOutcome};
pub use settings::DesignSettings;

use crate::error::Result;
use crate::motion::JerkControlledMotion;
use crate::simulate::{Purpose, initial_motion, stream};
use nalgebra::Vector3;
use search::search;

/// Finds the best motion; `progress` is called with 1 after each start.
///
/// # Errors
/// [`Error::Experiment`](crate::Error::Experiment) where nothing bounds the motion.
pub fn design(
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Design> {
    problem.check()?;
    let limits = problem.effective_limits();
    let initial = initial_motion(
        problem.intervals,
        problem.interval_s,
        problem.sensor.axes,
        &limits,
        &mut stream(settings.seed, Purpose::Motion, 0),
    )?;
    let rest =
        JerkControlledMotion::uniform(problem.interval_s, vec![Vector3::zeros(); problem.intervals + 1])?;
    let found = search(problem, settings, &limits, &initial, (&rest, 1.0), progress)?;
    let best = JerkControlledMotion::uniform(problem.interval_s, found.nodes)?;
    let initial = evaluate(problem, &initial)?;
    let optimal = evaluate(problem, &best)?;
    let certificate = if settings.certificate { certificate::certify(problem, optimal.value)? } else { None };
    Ok(Design {
        status: found.status,
        criterion: problem.criterion.clone(),
        parameters: problem.sensor.parameter_list().describe(problem.sensor, &problem.at),
        optimal,
        initial,
        iterations: found.starts.iter().map(|start| start.iterations).sum(),
        starts: found.starts,
        limits,
        certificate,
    })
}
