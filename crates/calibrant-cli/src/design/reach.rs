//! `calibrant design --reach` of a motion: the shortest one that is good enough.

use super::Arguments;
use super::output::finish;
use super::reach_request::{asked, evidence, goals};
use crate::console;
use crate::exit::Exit;
use calibrant::DesignPlan;
use calibrant::design::DesignProblem;
use calibrant::io::Reached;
use calibrant::report::number_format::{counted, short};

pub(super) fn run(
    arguments: &Arguments,
    job: &DesignPlan,
    problem: &DesignProblem<'_>,
) -> calibrant::Result<Exit> {
    let goals = goals(&arguments.reach, &problem.sensor.parameter_list(), problem.sensor.unit, &problem.at)?;
    let bar = console::spinner("starts");
    let found = job.shortest_motion(problem, &goals, &|done| bar.inc(done));
    bar.finish_and_clear();
    let found = found.map_err(|error| error.in_experiment(&arguments.experiment))?;
    let intervals = |count: usize| {
        format!("{} ({} s)", counted(count, "interval"), short(count as f64 * problem.interval_s))
    };
    let evidence = evidence(found.at_least, found.intervals, job.settings.starts, intervals);
    let wanted = asked(&arguments.reach);
    let sentence = format!("A motion of {} reaches {wanted}.{evidence}", intervals(found.intervals));
    let problem = DesignProblem { intervals: found.intervals, ..problem.clone() };
    let reached = Reached::new(&goals, &problem.sensor.parameter_list().names(), found.at_least);
    finish(arguments, job, &problem, &found.design, Some((&reached, &sentence)))
}
