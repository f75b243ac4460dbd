//! `calibrant design --evaluate` of recorded holds: how efficient they were.

use super::Arguments;
use super::pose_output::about;
use crate::console;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use calibrant::io::{PoseEvaluationFile, to_json, write_json, write_text};
use calibrant::report::pose_evaluation_sheet;
use calibrant::session::{SessionOptions, Source};
use calibrant::{DesignPlan, RecordedPoses};
use std::path::Path;

pub(super) fn run(arguments: &Arguments, job: &DesignPlan, recording: &Path) -> calibrant::Result<Exit> {
    let options = SessionOptions {
        experiment_file: arguments.experiment.clone(),
        report: false,
        ..SessionOptions::default()
    };
    let unit = job.experiment.sensor.unit;
    let found = job
        .evaluate_recorded(&Source::from_file(recording), options)
        .map_err(|error| error.in_experiment(&arguments.experiment))?;
    tell_all(&found.notes);
    let RecordedPoses { problem, directions, evaluation, .. } = found;
    let output = &arguments.output;
    let file =
        PoseEvaluationFile { evaluation: &evaluation, directions: &directions, problem: &problem, unit };
    write_json(&output.join("evaluation.json"), &file)?;
    let name = recording.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let about = about(arguments, &problem, &format!("Poses of {name}"));
    let page = output.join("evaluation.html");
    let sheet = pose_evaluation_sheet(&evaluation, &directions, &problem, unit, &about);
    write_text(&page, &sheet.html())?;
    console::result(arguments.json, || to_json(&file), &sheet, None, &[page])?;
    Ok(Exit::DONE)
}
