//! Design: the motion whose recording determines the parameters best, and the proof of how good it is.

mod admissible;
mod assessment;
mod certificate;
mod conic;
mod curvature;
mod evaluate;
mod feasibility;
mod hessian;
mod initial;
mod local;
mod problem;
mod region;
mod result;
mod search;
mod settings;
mod starts;
mod statement;
mod sweep;

pub use admissible::{LimitKind, LimitUse, ROUNDING, limit_use};
pub use assessment::{Assessment, OtherSetting, assess};
pub use evaluate::evaluate;
pub use feasibility::check_feasible;
pub use initial::initial_motion;
pub use problem::DesignProblem;
pub use result::{AT_BEST, Certificate, Design, DesignStatus, Evaluation, StartOutcome};
pub use settings::DesignSettings;
pub use sweep::{Sweep, SweepPoint, SweepVariable, sweep};

use crate::error::Result;
use crate::motion::JerkControlledMotion;
use crate::simulate::{Purpose, stream};
use search::search;

/// Finds the best motion; `progress` is called with 1 after each start.
///
/// # Errors
/// [`Error::Experiment`](crate::Error::Experiment) where nothing bounds the motion; [`Error::Infeasible`](crate::Error::Infeasible) where the limits
/// admit none.
pub fn design(
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Design> {
    problem.check()?;
    check_feasible(problem)?;
    let limits = problem.effective_limits();
    let initial = initial_motion(
        problem.intervals,
        problem.interval_s,
        problem.sensor.axes,
        &limits,
        &mut stream(settings.seed, Purpose::Motion, 0),
    )?;
    let (inside, slack) =
        feasibility::inside(&limits, problem.sensor.axes, problem.intervals, problem.interval_s)?;
    let found = search(problem, settings, &limits, &initial, (&inside, slack), progress)?;
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
