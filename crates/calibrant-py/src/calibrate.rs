//! Calibrates, and keeps what a report needs.

use crate::arrays::{Numbers, as_array};
use crate::experiment::Experiment;
use crate::failure::raised;
use crate::motion::Motion;
use crate::options::{Calibrate, parsed};
use crate::over_temperature::of_recordings;
use crate::source::Source;
use crate::work::{How, Run, run, run_as};
use calibrant::diagnostic::Diagnostic;
use calibrant::error::{InputError, Refusal};
use calibrant::session::{Given, Outcome as Found, Session, SessionOptions};
use calibrant::{CampaignCalibration, Error, is_ramp};
use pyo3::prelude::*;
use serde_json::json;
use std::sync::Arc;

/// A calibration with its report and its residuals.
#[pyclass(frozen)]
pub(crate) struct Outcome(Arc<Kept>);

enum Kept {
    OfRecording(Box<Found>),
    /// With what was noticed beside it.
    OverTemperature(Box<CampaignCalibration>, Vec<Diagnostic>),
}

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
        // without orders of its own, a recording of a campaign is one soak
        let is_soak = experiment.read.campaign_section().is_some()
            && experiment.read.imu.as_ref().is_none_or(|imu| imu.thermal.is_none());
        let read = if is_soak && source.further.is_empty() {
            experiment.read.of_one_soak().map_err(Experiment::placed(&experiment.file))?
        } else {
            experiment.read.clone()
        };
        let session = Session::with(read, options.clone())?;
        if is_soak && is_ramp(&session, &source).unwrap_or(false) {
            let held_out = options.validate.clone();
            let options = SessionOptions { validate: None, report: false, ..options };
            let progress = options.progress.clone();
            let (found, notes) =
                of_recordings(&experiment, vec![source], options, held_out.as_ref(), &progress)?;
            return Ok(Outcome::over_temperature(found, notes));
        }
        notes.extend_from_slice(session.notes());
        match session.calibrate(&source) {
            Ok(mut outcome) => {
                outcome.notes.splice(0..0, notes);
                Ok(Outcome(Arc::new(Kept::OfRecording(Box::new(outcome)))))
            }
            Err(error) if error.is_not_identifiable() => match session.one_pose(&source)? {
                Some(found) => Ok(Outcome::over_temperature(found, notes)),
                None => Err(error),
            },
            Err(error) => Err(error),
        }
    })
}

impl Outcome {
    pub(crate) fn over_temperature(found: CampaignCalibration, notes: Vec<Diagnostic>) -> Self {
        Self(Arc::new(Kept::OverTemperature(Box::new(found), notes)))
    }
}

#[pymethods]
impl Outcome {
    /// The text of `calibration.json`.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        self.of(py, |kept| match kept {
            Kept::OfRecording(found) => Ok(found.json()),
            Kept::OverTemperature(found, _) => Ok(found.json()),
        })
    }

    /// What was noticed beside the warnings, which the text of the calibration has.
    fn notes(&self) -> String {
        let notes = match self.0.as_ref() {
            Kept::OfRecording(found) => &found.notes,
            Kept::OverTemperature(_, notes) => notes,
        };
        json!(notes).to_string()
    }

    /// The text of `report.html`.
    fn html(&self, py: Python<'_>) -> PyResult<String> {
        self.of(py, |kept| match kept {
            Kept::OfRecording(found) => Ok(found.report_html()),
            Kept::OverTemperature(found, _) => Ok(found.sheet().html()),
        })
    }

    /// The sheet as text.
    fn text(&self, py: Python<'_>, width: usize) -> PyResult<String> {
        self.of(py, move |kept| match kept {
            Kept::OfRecording(found) => Ok(found.sheet().text(width)),
            Kept::OverTemperature(found, _) => Ok(found.sheet().text(width)),
        })
    }

    /// The residuals.
    fn residuals<'py>(&self, py: Python<'py>) -> PyResult<Vec<Series<'py>>> {
        let residuals = self.of(py, |kept| match kept {
            Kept::OfRecording(found) => Ok(found.residuals()),
            Kept::OverTemperature(..) => Err(Error::experiment(InputError::new(
                Refusal::CalibrationUnsuited,
                "a calibration over temperature has no residuals over time",
                "see `data[\"soaks\"]`: what each soak differs by from the fit",
            ))),
        })?;
        let series = residuals.series.iter().map(|of| {
            let axis = of.axis.map(|axis| ["x", "y", "z"][axis.index()]);
            let columns = [&of.times_s, &of.residuals, &of.sd, &of.weights].map(|list| as_array(py, list));
            ((of.kind, of.sensor.name(), axis, of.unit), columns)
        });
        Ok(series.collect())
    }
}

impl Outcome {
    /// What a look at it gives.
    fn of<T: Send + 'static>(
        &self,
        py: Python<'_>,
        look: impl FnOnce(&Kept) -> calibrant::Result<T> + Send + 'static,
    ) -> PyResult<T> {
        let kept = Arc::clone(&self.0);
        run(py, move || look(&kept))
    }
}
