//! `calibrant calibrate`: from recordings to parameters with their covariance.

mod accelerometer;
mod arguments;
mod batch;
mod earlier;
mod imu;
mod imu_noise;
mod imu_output;
mod validation;

pub(crate) use arguments::Arguments;

use crate::{Exit, console, output_places};
use accelerometer::{Job, show};
use calibrant::io::Experiment;
use earlier::warn_of_earlier_result;

pub(crate) fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    output_places::check_directory(&arguments.output)?;
    arguments.check_inputs(&[String::new()])?;
    let experiment = Experiment::read(&arguments.experiment)?;
    if let Some(plan) = &experiment.imu {
        return imu::run(arguments, &experiment, plan);
    }
    let job = Job::prepare(arguments, experiment)?;
    let [recording] = arguments.recordings.as_slice() else {
        validation::only_one(arguments)?;
        return batch::run(arguments, &["p-value"], |number, directory| {
            job.one_of_many(&arguments.recordings[number], directory, arguments)
        });
    };
    let outcome = job.run(recording).and_then(|mut done| {
        done.validations = validation::of_accelerometer(&job, arguments, &done)?;
        job.write(&done, recording, &arguments.output)?;
        Ok(done)
    });
    match outcome {
        Ok(done) => {
            let exit = show(&done, arguments);
            Ok(exit.max(Exit::of_status(done.calibration.status)))
        }
        Err(error) => {
            warn_of_earlier_result(&arguments.output);
            console::error_in(&error, recording);
            Ok(Exit::of(&error))
        }
    }
}
