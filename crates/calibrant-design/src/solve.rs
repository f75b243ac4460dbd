//! The design of the best motion: feasibility first, then the search, and the certificate beside it.

use super::multistart_search::search;
use super::{
    Design, DesignProblem, DesignSettings, DesignStatus, certificate, check_feasible, evaluate, feasibility,
    initial_motion,
};
use calibrant_core::error::Result;
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::simulate::{Purpose, stream};

/// Finds the best motion; `progress` is called with 1 after each start.
///
/// Where it is interrupted, the design is the best motion so far, with a bound that takes no time. It says so in
/// its status.
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
    let (found, bound) = rayon::join(
        || search(problem, settings, &limits, &initial, (&inside, slack), progress),
        || {
            let wanted = settings.certificate;
            wanted.then(|| certificate::lower_bound(problem, &settings.interruption)).transpose()
        },
    );
    let found = found?;
    let best = JerkControlledMotion::uniform(problem.interval_s, found.nodes)?;
    let floor = problem.floor();
    let initial = evaluate(problem, &initial)?;
    let optimal = evaluate(problem, &best)?;
    let certificate =
        bound?.flatten().map(|bound| bound.certificate(&problem.criterion, optimal.value, floor));
    let interrupted = settings.interruption.is_asked();
    Ok(Design {
        status: if interrupted { DesignStatus::Interrupted } else { found.status },
        criterion: problem.criterion.clone(),
        parameters: problem.sensor.parameter_list().describe(problem.sensor, &problem.at),
        optimal,
        initial,
        iterations: found.starts.iter().map(|start| start.iterations).sum(),
        starts: found.starts,
        limits,
        certificate,
        floor,
        floor_sd: problem.floor_sd(),
    })
}
