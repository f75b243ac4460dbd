//! One calibration over temperature: of the recordings of soaks, or of their calibrations.

use crate::calibrate::Outcome;
use crate::experiment::Experiment;
use crate::failure::raised;
use crate::options::{Calibrate, parsed};
use crate::over_temperature::{of_recordings, over_temperature};
use crate::source::Source;
use crate::work::{How, Run, run_as};
use calibrant::Result;
use calibrant::batch::folder_names;
use calibrant::session::SessionOptions;
use pyo3::prelude::*;

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
        let (found, notes) = of_recordings(&experiment, sources, options, held_out.as_ref(), &progress)?;
        Ok(Outcome::over_temperature(found, notes))
    })
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
        let (found, notes) = over_temperature(&experiment, soaks, options, (held_out.as_ref(), Vec::new()))?;
        Ok(Outcome::over_temperature(found, notes))
    })
}

fn options_of(text: &str) -> Result<SessionOptions> {
    Ok(SessionOptions { report: false, ..parsed::<Calibrate>(text)?.options()? })
}
