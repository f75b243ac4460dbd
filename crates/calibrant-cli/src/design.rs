//! `calibrant design`: finds the motion whose recording determines the parameters best.

mod arguments;
mod evaluate;
mod job;
mod output;
mod sweep;
mod sweep_request;
mod table;

pub(crate) use arguments::Arguments;

use crate::{Exit, console, output_places};
use calibrant::design::DesignProblem;
use calibrant::io::design_json;
use job::{Job, in_file};
use output::{exit_of, write};

pub(crate) fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    output_places::check_directory(&arguments.output)?;
    let job = Job::prepare(arguments)?;
    let problem = job.problem(&arguments.experiment)?;
    match (&arguments.evaluate, &arguments.sweep) {
        (Some(path), _) => evaluate::run(arguments, &job, &problem, path),
        (None, Some(request)) => sweep::run(arguments, &job, &problem, request),
        (None, None) => run_design(arguments, &job, &problem),
    }
}

fn run_design(arguments: &Arguments, job: &Job, problem: &DesignProblem<'_>) -> calibrant::Result<Exit> {
    let design = job.design(problem).map_err(|error| in_file(error, &arguments.experiment))?;
    write(arguments, job, problem, &design)?;
    if arguments.json {
        console::print(&design_json(&design, problem, &job.settings));
    } else {
        console::print(&table::design(&design));
        let output = &arguments.output;
        console::print(&format!(
            "\n{}\n{}\n",
            output.join("motion.csv").display(),
            output.join("report.html").display()
        ));
    }
    Ok(exit_of(&design))
}
