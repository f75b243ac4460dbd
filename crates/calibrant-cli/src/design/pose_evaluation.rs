//! `calibrant design --evaluate` of recorded holds: how efficient they were.

use super::job::{Job, in_file};
use super::pose_output::{about, write_page};
use super::{Arguments, pose_table};
use crate::diagnostics::tell_all;
use crate::{Exit, console};
use calibrant::design::poses::evaluate_poses;
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{PoseEvaluationFile, to_json, write_json};
use calibrant::report::{evaluation_in_words, pose_evaluation_report};
use calibrant::session::{Session, SessionOptions, Source};
use std::path::Path;

pub(super) fn run(arguments: &Arguments, job: &Job, recording: &Path) -> calibrant::Result<Exit> {
    if !arguments.from.is_empty() {
        let message = "--from is not used: the holds of a recording are compared with the best by themselves";
        return Err(Error::experiment(InputError::new(
            Refusal::ExperimentUnsuited,
            message,
            "leave it away, or design the next poses with --from and --add",
        )));
    }
    let options = SessionOptions {
        experiment_file: arguments.experiment.clone(),
        report: false,
        ..SessionOptions::default()
    };
    let outcome = Session::with(job.experiment.clone(), options)?.calibrate(&Source::from_file(recording))?;
    tell_all(&outcome.notes);
    let Some(calibration) = outcome.calibration() else {
        let message = "the holds of a machine are not compared with the best";
        let help = "see `calibrant init static-poses`";
        return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
    };
    let (problem, directions) =
        job.experiment.recorded_poses(calibration).map_err(|error| in_file(error, &arguments.experiment))?;
    let unit = job.experiment.sensor.unit;
    let evaluation = evaluate_poses(&problem, &directions, job.settings.seed)?;
    let output = &arguments.output;
    let file =
        PoseEvaluationFile { evaluation: &evaluation, directions: &directions, problem: &problem, unit };
    write_json(&output.join("evaluation.json"), &file)?;
    let name = recording.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let about = about(arguments, &problem, &format!("Poses of {name}"));
    let page = output.join("evaluation.html");
    write_page(&page, &pose_evaluation_report(&evaluation, &directions, &problem, unit, &about))?;
    if arguments.json {
        console::print_always(&to_json(&file));
    } else {
        console::print(&pose_table::evaluation(&evaluation, &problem, unit));
        console::print(&console::paragraph(&evaluation_in_words(&evaluation, directions.len())));
        console::print(&format!("\n{}\n", page.display()));
    }
    Ok(Exit::DONE)
}
