//! The design of the best motion: feasibility first, then the search, and the certificate beside it.

use super::shuttle::best_shuttle;
use crate::certificate::LowerBound;
use crate::limits::{initial_motion, inside};
use crate::local_search::SHORT;
use crate::search::search;
use crate::{
    Design, DesignProblem, DesignSettings, DesignStatus, GapGoal, certificate, check_feasible, evaluate,
};
use calibrant_core::budget::Budget;
use calibrant_core::error::Result;
use calibrant_core::motion::{JerkControlledMotion, Trust};
use calibrant_core::sensor::SensorModel;
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
    let (inside, slack) = inside(&limits, problem.sensor.axes, problem.intervals, problem.interval_s)?;
    settings.so_far.begin(problem.sensor.axes);
    let bound = || -> Result<Option<LowerBound>> {
        if !settings.certificate {
            return Ok(None);
        }
        let bound = certificate::lower_bound(problem, &settings.interruption)?;
        bound.iter().for_each(|bound| settings.so_far.bounded(bound.value));
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
    let shuttle = best_shuttle(problem, &limits)?;
    let optimal = evaluate(problem, &best)?;
    let certificate = bound.map(|bound| bound.certificate(&problem.criterion, optimal.value, floor));
    let interrupted = settings.interruption.is_asked();
    Ok(Design {
        status: if interrupted { DesignStatus::Interrupted } else { found.status },
        criterion: problem.criterion.clone(),
        parameters: problem.sensor.parameter_list().describe(problem.sensor, &problem.at),
        optimal,
        initial,
        shuttle,
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

impl DesignSettings {
    /// What the design of this motion takes at most. The search ends earlier where starts agree.
    #[must_use]
    pub fn work(&self, problem: &DesignProblem<'_>) -> Budget {
        let sensor = problem.sensor;
        // measured, within a factor of four: the axes of a full sensor are one problem, of their cube in time
        let (parts, size) = match sensor.model {
            SensorModel::ScaleBias => (sensor.axes, 1.0),
            SensorModel::Full => (1, (sensor.axes as f64).powi(3)),
        };
        let noisy = if matches!(problem.trust, Trust::Noisy(_)) { 2.0 } else { 1.0 };
        let (starts, intervals) = ((self.starts * parts) as f64, problem.intervals as f64);
        // the program of a long motion takes time in proportion to its length, as far as its iterations do
        let axes = if parts == 1 { sensor.axes } else { 1 };
        let per_interval = 2e-4 + 1e-5 * intervals;
        let per_interval =
            if (problem.intervals + 1) * axes > SHORT { per_interval.min(5e-4) } else { per_interval };
        Budget {
            bytes: starts * (24.0 * intervals + 500.0) + 1e4 * intervals,
            seconds: self.seconds.unwrap_or(starts * size * noisy * intervals * per_interval),
        }
    }
}
