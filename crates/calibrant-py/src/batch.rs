//! Many recordings in one call: a chunk of a fleet.

use crate::experiment::Experiment;
use crate::failure::{as_json, raised};
use crate::motion::Motion;
use crate::options::{Calibrate, parsed};
use crate::source::Source;
use crate::work::{How, Run, run, run_as};
use calibrant::batch::{Batch, BatchOptions};
use calibrant::session::{Session, SessionOptions};
use pyo3::prelude::*;
use serde_json::json;

/// Calibrates from each recording. Returns for each its key, its hash, the text of its calibration, and its error as JSON.
#[pyfunction]
#[pyo3(signature = (experiment, sources, options, *, motion=None, threads=None, progress=None))]
pub(crate) fn calibrate_each(
    py: Python<'_>,
    experiment: &Experiment,
    sources: Vec<PyRef<'_, Source>>,
    options: &str,
    motion: Option<&Motion>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Vec<BatchRow>> {
    let options = parsed::<Calibrate>(options).and_then(|options| options.options());
    let motion = motion.map(|motion| motion.0.clone());
    let options = SessionOptions { motion, ..options.map_err(|error| raised(py, &error))? };
    let sources: Vec<_> = sources.iter().map(|source| source.0.clone()).collect();
    let experiment = experiment.clone();
    let how = How { threads, progress, keeps_the_best: false };
    run_as(py, how, move |Run { interruption, progress }| {
        let session = Session::with(experiment.read, SessionOptions { interruption, ..options })?;
        let kept = BatchOptions { keep_json: true, ..BatchOptions::default() };
        let results = Batch::new(session, sources, kept)?.run(&progress);
        let rows = results.rows.into_iter().map(|row| {
            let hash = row.files.map(|files| files.into_iter().map(|file| file.sha256).collect::<String>());
            let (text, error) = match row.outcome {
                Ok(result) => (Some(result.json), None),
                Err(error) => {
                    let text = error.to_string();
                    let mut data = as_json(&error);
                    data["text"] = json!(text);
                    (None, Some(data.to_string()))
                }
            };
            (row.key.map(|key| key.as_str().to_owned()), hash, text, error)
        });
        Ok(rows.collect())
    })
}

/// Key, hash, calibration, error.
type BatchRow = (Option<String>, Option<String>, Option<String>, Option<String>);

/// The key of each result, without its computation; `None` where a file cannot be read.
#[pyfunction]
#[pyo3(signature = (experiment, sources, options, *, motion=None))]
pub(crate) fn keys(
    py: Python<'_>,
    experiment: &Experiment,
    sources: Vec<PyRef<'_, Source>>,
    options: &str,
    motion: Option<&Motion>,
) -> PyResult<Vec<Option<String>>> {
    let options = parsed::<Calibrate>(options).and_then(|options| options.options());
    let motion = motion.map(|motion| motion.0.clone());
    let options = SessionOptions { motion, ..options.map_err(|error| raised(py, &error))? };
    let sources: Vec<_> = sources.iter().map(|source| source.0.clone()).collect();
    let experiment = experiment.clone();
    run(py, move || {
        let session = Session::with(experiment.read, options)?;
        let shared = session.key();
        let key = |source: &calibrant::session::Source| {
            Some(shared.as_ref()?.with(&source.hashed()?).as_str().to_owned())
        };
        Ok(sources.iter().map(key).collect())
    })
}
