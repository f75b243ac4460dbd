//! `calibrant design --reach` of a motion: the shortest one that is good enough.

use super::job::{Job, in_file};
use super::reach_request::goals;
use super::{Arguments, finish};
use crate::{Exit, console};
use calibrant::design::{DesignProblem, shortest_motion};
use calibrant::report::number_format::{counted, short};

pub(super) fn run(arguments: &Arguments, job: &Job, problem: &DesignProblem<'_>) -> calibrant::Result<Exit> {
    job.check_work(problem)?;
    let gain = problem.at.matrix.diagonal().mean();
    let list = problem.sensor.parameter_list();
    let goals = goals(&arguments.reach, &list, problem.sensor.unit, gain)?;
    let bar = console::spinner("starts");
    let found = shortest_motion(problem, &goals, &job.settings, &|done| bar.inc(done));
    bar.finish_and_clear();
    let found = found.map_err(|error| in_file(error, &arguments.experiment))?;
    let duration = |intervals: usize| short(intervals as f64 * problem.interval_s);
    let wanted: Vec<String> =
        arguments.reach.iter().map(|request| format!("{} to {}", request.name, request.text)).collect();
    let proof = found.at_least.map_or_else(String::new, |least| {
        format!(
            " No motion of fewer than {} ({} s) can, within these limits.",
            counted(least, "interval"),
            duration(least)
        )
    });
    let remark = format!(
        "{} ({} s) reach {}.{proof}",
        counted(found.intervals, "interval"),
        duration(found.intervals),
        wanted.join(" and ")
    );
    let problem = DesignProblem { intervals: found.intervals, ..problem.clone() };
    finish(arguments, job, &problem, &found.design, Some(&remark))
}
