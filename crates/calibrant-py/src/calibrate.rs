//! Calibrates, and keeps what a report needs.

use crate::arrays::{Numbers, as_array};
use crate::experiment::Experiment;
use crate::failure::raised;
use crate::motion::Motion;
use crate::options::{Calibrate, parsed};
use crate::source::Source;
use crate::work::{How, Run, run, run_as};
use calibrant::session::{Given, Outcome as Found, Session, SessionOptions};
use pyo3::prelude::*;
use serde_json::json;
use std::sync::Arc;

/// A calibration with its report and its residuals.
#[pyclass(frozen)]
pub(crate) struct Outcome(Arc<Found>);

/// Kind, sensor, axis and unit of residuals; then times, residuals, standard deviations, and weights.
type Series<'py> = ((&'static str, &'static str, Option<&'static str>, &'static str), [Numbers<'py>; 4]);

/// Calibrates from a recording.
#[pyfunction]
#[pyo3(signature = (experiment, source, options, *, motion=None, validate=None, validate_motion=None, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "each is an argument of the Python function")]
pub(crate) fn calibrate(
    py: Python<'_>,
    experiment: &Experiment,
    source: &Source,
    options: &str,
    motion: Option<&Motion>,
    validate: Option<&Source>,
    validate_motion: Option<&Motion>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Outcome> {
    let options = parsed::<Calibrate>(options).and_then(|options| options.options());
    let options = SessionOptions {
        motion: motion.map(|motion| motion.0.clone()),
        validate: validate.map(|source| source.0.clone()),
        validate_motion: validate_motion.map(|motion| motion.0.clone()),
        ..options.map_err(|error| raised(py, &error))?
    };
    let (experiment, source) = (experiment.clone(), source.0.clone());
    let how = How { threads, progress, keeps_the_best: false };
    run_as(py, how, move |Run { interruption, progress }| {
        let given = Given {
            motion: options.motion.is_some(),
            validate_motion: options.validate_motion.is_some(),
            gyroscope: false, // a recording has it, or has it not
            sections: source.sections.is_some(),
        };
        let mut notes = given.unused_by(&experiment.read);
        let options = SessionOptions { interruption, progress, ..options };
        let session = Session::with(experiment.read, options)?;
        let mut outcome = session.calibrate(&source)?;
        notes.extend_from_slice(session.notes());
        outcome.notes.splice(0..0, notes);
        Ok(Outcome(Arc::new(outcome)))
    })
}

#[pymethods]
impl Outcome {
    /// The text of `calibration.json`.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        let found = Arc::clone(&self.0);
        run(py, move || Ok(found.json()))
    }

    /// What was noticed beside the warnings, which the text of the calibration has.
    fn notes(&self) -> String {
        json!(self.0.notes).to_string()
    }

    /// The text of `report.html`.
    fn html(&self, py: Python<'_>) -> PyResult<String> {
        let found = Arc::clone(&self.0);
        run(py, move || Ok(found.report_html()))
    }

    /// The sheet as text.
    fn text(&self, py: Python<'_>, width: usize) -> PyResult<String> {
        let found = Arc::clone(&self.0);
        run(py, move || Ok(found.sheet().text(width)))
    }

    /// The residuals.
    fn residuals<'py>(&self, py: Python<'py>) -> PyResult<Vec<Series<'py>>> {
        let found = Arc::clone(&self.0);
        let residuals = run(py, move || Ok(found.residuals()))?;
        let series = residuals.series.iter().map(|of| {
            let axis = of.axis.map(|axis| ["x", "y", "z"][axis.index()]);
            let columns = [&of.times_s, &of.residuals, &of.sd, &of.weights].map(|list| as_array(py, list));
            ((of.kind, of.sensor.name(), axis, of.unit), columns)
        });
        Ok(series.collect())
    }
}
