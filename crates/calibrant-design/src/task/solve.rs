//! The design of the best motion: feasibility first, then the search, and the certificate beside it.

use crate::certificate::LowerBound;
use crate::limits::feasibility;
use crate::limits::initial_motion::initial_motion;
use crate::search::multistart_search::search;
use crate::{
    Design, DesignProblem, DesignSettings, DesignStatus, GapGoal, certificate, check_feasible, evaluate,
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
/// [`Error::Experiment`](calibrant_core::Error::Experiment) where nothing bounds the motion, or the gap of the settings is not above 0; [`Error::Infeasible`](calibrant_core::Error::Infeasible) where the limits
/// admit none.
pub fn design(
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Design> {
    problem.check()?;
    settings.check()?;
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
    settings.so_far.begin(problem.sensor.axes);
    let bound = || -> Result<Option<LowerBound>> {
        if !settings.certificate {
            return Ok(None);
        }
        let bound = certificate::lower_bound(problem, &settings.interruption)?;
        bound.iter().for_each(|bound| settings.so_far.bounded(bound.value()));
        Ok(bound)
    };
    let search = |bound: Option<&LowerBound>| {
        search(problem, settings, bound, &limits, &initial, (&inside, slack), progress)
    };
    let (found, bound) = if settings.gap.is_some() {
        // what the search does may depend on the bound, but not on when it is found
        let bound = bound()?;
        (search(bound.as_ref())?, bound)
    } else {
        let (found, bound) = rayon::join(|| search(None), bound);
        (found?, bound?)
    };
    let best = JerkControlledMotion::uniform(problem.interval_s, found.nodes)?;
    let floor = problem.floor();
    let initial = evaluate(problem, &initial)?;
    let optimal = evaluate(problem, &best)?;
    let certificate = bound.map(|bound| bound.certificate(&problem.criterion, optimal.value, floor));
    let interrupted = settings.interruption.is_asked();
    Ok(Design {
        status: if interrupted { DesignStatus::Interrupted } else { found.status },
        criterion: problem.criterion.clone(),
        parameters: problem.sensor.parameter_list().describe(problem.sensor, &problem.at),
        optimal,
        initial,
        iterations: found.starts.iter().map(|start| start.iterations).sum(),
        starts: found.starts,
        gap_goal: settings
            .gap
            .filter(|_| settings.certificate)
            .map(|gap| GapGoal { gap, most_starts: settings.starts * problem.sensor.axes }),
        limits,
        certificate,
        floor,
        floor_sd: problem.floor_sd(),
    })
}
