//! The design of the best motion: feasibility, search, certificate, in this order.

use super::multistart_search::search;
use super::{
    Design, DesignProblem, DesignSettings, certificate, check_feasible, evaluate, feasibility, initial_motion,
};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::simulate::{Purpose, stream};

/// Finds the best motion; `progress` is called with 1 after each start.
///
/// # Errors
/// [`Error::Experiment`](calibrant_core::Error::Experiment) where nothing bounds the motion; [`Error::Infeasible`](calibrant_core::Error::Infeasible) where the limits
/// admit none.
pub fn design(
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Design> {
    problem.check()?;
    check_work(problem, settings)?;
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

/// Returns an error for a search that would take more than about ten minutes of one processor.
fn check_work(problem: &DesignProblem<'_>, settings: &DesignSettings) -> Result<()> {
    /// Most starts × intervals² of an axis: a start with 10 intervals takes about 2 ms.
    const MOST: f64 = 3e7;
    let (starts, intervals) = (settings.starts as f64, problem.intervals as f64);
    let work = starts * intervals * intervals;
    if work <= MOST {
        return Ok(());
    }
    let message = format!(
        "{starts} starts with {intervals} intervals: starts × intervals² is {work:.1e}, at most {MOST:.0e}"
    );
    Err(Error::experiment(InputError::new(Refusal::WorkTooLarge, message, "take fewer starts or intervals")))
}
