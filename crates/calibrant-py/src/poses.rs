//! Designs of poses, and poses beside the best ones.

use crate::arrays::{Numbers, as_table, vectors};
use crate::choice::{Choice, chosen, counter};
use crate::experiment::Experiment;
use crate::failure::raised;
use crate::options::{Reading, parsed};
use crate::page::{Page, page};
use crate::source::Source;
use crate::work::{How, run_as};
use calibrant::design::poses::evaluate_poses;
use calibrant::diagnostic::Diagnostic;
use calibrant::diagnostic::design::SearchInterrupted;
use calibrant::io::{PoseDesignFile, PoseEvaluationFile, to_json};
use calibrant::report::{About, pose_evaluation_sheet, pose_sheet};
use calibrant::session::SessionOptions;
use calibrant::{ReachedDesign, RecordedPoses, Result};
use pyo3::prelude::*;

/// The result, and the directions: unit vectors, the axis that is up in each pose.
type Found<'py> = (Page, Numbers<'py>);

/// Finds the best poses, or the fewest that reach goals.
#[pyfunction]
#[pyo3(signature = (experiment, poses, choice, *, threads=None, progress=None))]
pub(crate) fn design_poses<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    poses: Option<usize>,
    choice: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Found<'py>> {
    let how = (threads, progress);
    let (page, directions) = chosen(py, experiment, choice, how, move |experiment, choice, given| {
        let placed = Experiment::placed(&experiment.file);
        let plan = choice.plan(experiment, given)?;
        let problem = plan.pose_problem(poses).map_err(&placed)?;
        let goals = choice.reach()?;
        let told = counter(given, "starts", plan.settings.starts as u64);
        let (design, reached, sentence) = if goals.is_empty() {
            (plan.design_poses(&problem, &told).map_err(&placed)?, None, None)
        } else {
            let found = plan.reach_by_poses(&problem, &goals, &told).map_err(&placed)?;
            let ReachedDesign { design, reached, sentence } = found;
            (design, Some(reached), Some(sentence))
        };
        let mut notes = plan.notes.clone();
        notes.extend(design.interrupted.then(|| Diagnostic::from(SearchInterrupted { are_poses: true })));
        let unit = experiment.read.sensor.unit;
        let file = PoseDesignFile { design: &design, reached: reached.as_ref(), problem: &problem, unit };
        let findings = sentence.into_iter().collect();
        let about = About { title: "Poses for a static calibration".into(), findings, ..About::default() };
        let page = page(to_json(&file), &notes, &pose_sheet(&design, &problem, unit, &about));
        Ok((page, design.directions))
    })?;
    Ok((page, as_table(py, &directions)))
}

/// Puts directions, or the holds of a recording, beside the best poses.
#[pyfunction]
#[pyo3(signature = (experiment, choice, *, directions=None, source=None, reading="{}", threads=None))]
pub(crate) fn assess_poses<'py>(
    py: Python<'py>,
    experiment: &Experiment,
    choice: &str,
    directions: Option<&[u8]>,
    source: Option<&Source>,
    reading: &str,
    threads: Option<usize>,
) -> PyResult<Found<'py>> {
    let read = || -> Result<_> { Ok((parsed::<Choice>(choice)?, parsed::<Reading>(reading)?.options()?)) };
    let (choice, reading) = read().map_err(|error| raised(py, &error))?;
    let directions = directions.map(vectors).unwrap_or_default();
    let source = source.map(|source| source.0.clone());
    let experiment = experiment.clone();
    let how = How { threads, ..How::default() };
    let (page, directions) = run_as(py, how, move |given| {
        let placed = Experiment::placed(&experiment.file);
        let plan = choice.plan(&experiment, &given)?;
        let found = match source {
            Some(source) => {
                let interruption = given.interruption.clone();
                let experiment_file = experiment.file.clone();
                let options = SessionOptions {
                    reading,
                    interruption,
                    experiment_file,
                    report: false,
                    ..SessionOptions::default()
                };
                plan.evaluate_recorded(&source, options).map_err(&placed)?
            }
            None => {
                let problem = plan.pose_problem(Some(directions.len())).map_err(&placed)?;
                let evaluation = evaluate_poses(&problem, &directions, plan.settings.seed)?;
                RecordedPoses { problem, directions, evaluation, notes: plan.notes.clone() }
            }
        };
        let RecordedPoses { problem, directions, evaluation, notes } = found;
        let unit = experiment.read.sensor.unit;
        let file =
            PoseEvaluationFile { evaluation: &evaluation, directions: &directions, problem: &problem, unit };
        let about = About { title: "Assessment of poses".into(), ..About::default() };
        let sheet = pose_evaluation_sheet(&evaluation, &directions, &problem, unit, &about);
        let page = page(to_json(&file), &notes, &sheet);
        drop(sheet);
        Ok((page, directions))
    })?;
    Ok((page, as_table(py, &directions)))
}
