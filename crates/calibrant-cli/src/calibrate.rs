//! `calibrant calibrate`: from recordings to parameters with their covariance.

mod arguments;
mod batch;
mod earlier;
mod job;
mod one;
mod quality;
mod sources;
mod unused;

pub(crate) use arguments::Arguments;

use crate::{Exit, output_places};
use calibrant::io::Experiment;
use job::Job;

pub(crate) fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    output_places::check_directory(&arguments.output)?;
    arguments.check_inputs(&[String::new()])?;
    let experiment = Experiment::read(&arguments.experiment)?;
    unused::warn(arguments, &experiment);
    let job = Job::prepare(arguments, &experiment)?;
    match job.sources.as_slice() {
        [source] => Ok(one::run(&job, source)),
        _ => batch::run(&job),
    }
}
