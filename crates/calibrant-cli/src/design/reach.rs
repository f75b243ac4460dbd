//! `calibrant design --reach` of a motion: the shortest one that is good enough.

use super::Arguments;
use super::output::finish;
use crate::console;
use crate::exit::Exit;
use calibrant::DesignPlan;
use calibrant::design::DesignProblem;

pub(super) fn run(
    arguments: &Arguments,
    job: &DesignPlan,
    problem: &DesignProblem<'_>,
) -> calibrant::Result<Exit> {
    let bar = console::spinner("starts");
    let found = job.reach(problem, &arguments.reach, &|done| bar.inc(done));
    bar.finish_and_clear();
    let (problem, found) = found.map_err(|error| error.in_experiment(&arguments.experiment))?;
    finish(arguments, job, &problem, &found.design, Some((&found.reached, &found.sentence)))
}
