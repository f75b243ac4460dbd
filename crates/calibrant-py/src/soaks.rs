//! One calibration over temperature: of the recordings of soaks, or of their calibrations.

use crate::calibrate::Outcome;
use crate::experiment::Experiment;
use crate::failure::raised;
use crate::options::{Calibrate, parsed};
use crate::source::Source;
use crate::work::{How, Run, run_as};
use calibrant::batch::{Batch, BatchOptions, BatchRow, folder_names};
use calibrant::diagnostic::Diagnostic;
use calibrant::progress::Progress;
use calibrant::session::{Session, SessionOptions};
use calibrant::{CampaignCalibration, Error, Result, calibrate_soaks as calibrated_soaks};
use pyo3::prelude::*;

/// A soak's name, and the text of its calibration or why there is none.
type Soak = (String, std::result::Result<String, String>);

/// Calibrates each soak by itself, then over temperature.
#[pyfunction]
#[pyo3(signature = (experiment, sources, options, *, validate=None, threads=None, progress=None))]
pub(crate) fn calibrate_campaign(
    py: Python<'_>,
    experiment: &Experiment,
    sources: Vec<PyRef<'_, Source>>,
    options: &str,
    validate: Option<PyRef<'_, Source>>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let options = options_of(options).map_err(|error| raised(py, &error))?;
    let sources: Vec<_> = sources.iter().map(|source| source.0.clone()).collect();
    let held_out = validate.map(|source| source.0.clone());
    let experiment = experiment.clone();
    run_as(py, How { threads, progress, keeps_the_best: false }, move |Run { interruption, progress }| {
        let options = SessionOptions { interruption, ..options };
        of_recordings(&experiment, sources, options, held_out.as_ref(), &progress)
    })
}

/// Calibrates each recording by itself, a ramp in pieces, then over temperature.
pub(crate) fn of_recordings(
    experiment: &Experiment,
    sources: Vec<calibrant::session::Source>,
    options: SessionOptions,
    held_out: Option<&calibrant::session::Source>,
    progress: &Progress,
) -> Result<Outcome> {
    let of_one = experiment.read.of_one_soak().map_err(Experiment::placed(&experiment.file))?;
    let session = Session::with(of_one, options.clone())?;
    let batch = Batch::new(session, sources, BatchOptions { keep_json: true, ..BatchOptions::default() })?;
    let rows = batch.run(progress).rows;
    let (mut rows, notes) = calibrated_soaks(&experiment.read, batch, rows, progress)?;
    // where none can be used, the first says why
    if rows.iter().all(|row| row.outcome.is_err()) && !rows.is_empty() {
        let BatchRow { outcome, recording, .. } = rows.swap_remove(0);
        outcome.map_err(|error| error.in_recording(&recording))?;
    }
    let soak = |row: BatchRow| {
        let text = row.outcome.map(|result| result.json).map_err(|error| error.to_string());
        (row.folder, text)
    };
    let soaks = rows.into_iter().map(soak).collect();
    over_temperature(experiment, soaks, options, (held_out, notes))
}

/// Calibrates over temperature from the calibrations of the soaks: the name of each, and its text.
#[pyfunction]
#[pyo3(signature = (experiment, soaks, options, *, validate=None))]
pub(crate) fn calibrate_soaks(
    py: Python<'_>,
    experiment: &Experiment,
    soaks: Vec<(String, String)>,
    options: &str,
    validate: Option<PyRef<'_, Source>>,
) -> PyResult<Outcome> {
    let options = options_of(options).map_err(|error| raised(py, &error))?;
    let held_out = validate.map(|source| source.0.clone());
    let experiment = experiment.clone();
    run_as(py, How::default(), move |_| {
        let (names, texts): (Vec<String>, Vec<String>) = soaks.into_iter().unzip();
        let soaks = folder_names(&names).into_iter().zip(texts.into_iter().map(Ok)).collect();
        over_temperature(&experiment, soaks, options, (held_out.as_ref(), Vec::new()))
    })
}

fn options_of(text: &str) -> Result<SessionOptions> {
    Ok(SessionOptions { report: false, ..parsed::<Calibrate>(text)?.options()? })
}

fn over_temperature(
    experiment: &Experiment,
    soaks: Vec<Soak>,
    options: SessionOptions,
    (held_out, mut notes): (Option<&calibrant::session::Source>, Vec<Diagnostic>),
) -> Result<Outcome> {
    let found = CampaignCalibration::of_soaks(&experiment.read, soaks, &options.allowed, &mut notes);
    let mut found =
        found.map_err(|error| with_reason(error, &notes)).map_err(Experiment::placed(&experiment.file))?;
    if let Some(held_out) = held_out {
        let of_one = experiment.read.of_one_soak().map_err(Experiment::placed(&experiment.file))?;
        found = found.validate(&Session::with(of_one, options)?, held_out)?;
    }
    Ok(Outcome::over_temperature(found, notes))
}

/// The error with why the first soak was left out: nobody sees the notes of what failed.
fn with_reason(error: Error, notes: &[Diagnostic]) -> Error {
    match (error, notes.first()) {
        (Error::Recording(mut of), Some(note)) => {
            of.message = format!("{}: {note}", of.message);
            Error::Recording(of)
        }
        (error, _) => error,
    }
}
