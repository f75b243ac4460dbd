//! Studies of simulated sensors.

use crate::experiment::Experiment;
use crate::motion::Motion;
use crate::options::budget;
use crate::work::{How, run_as};
use calibrant::io::{StudyFile, to_json};
use calibrant::report::{About, study_sheet};
use calibrant::{StudyChoice, StudyPlan};
use pyo3::prelude::*;
use serde_json::json;
use std::sync::atomic::{AtomicU64, Ordering};

/// Runs the studies of an experiment: the text of `study.json`, what was noticed, and the sheet as text and as a page.
#[pyfunction]
#[pyo3(signature = (experiment, *, motion=None, sensors=None, starts=None, seed=None, force=false, threads=None, progress=None, width=100))]
#[expect(clippy::too_many_arguments, reason = "each is an argument of the Python function")]
pub(crate) fn study(
    py: Python<'_>,
    experiment: &Experiment,
    motion: Option<&Motion>,
    sensors: Option<usize>,
    starts: Option<usize>,
    seed: Option<u64>,
    force: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    width: usize,
) -> PyResult<(String, String, String, String)> {
    let motion = motion.map(|motion| motion.0.clone());
    let experiment = experiment.clone();
    let how = How { threads, progress, keeps_the_best: true };
    run_as(py, how, move |given| {
        let interruption = given.interruption.clone();
        let choice = StudyChoice { motion, sensors, seed, starts, budget: budget(force), interruption };
        let plan = StudyPlan::new(&experiment.read, &choice).map_err(Experiment::placed(&experiment.file))?;
        let (done, steps) = (AtomicU64::new(0), plan.steps());
        let studies = plan.run(&|more| {
            let done = done.fetch_add(more, Ordering::Relaxed) + more;
            given.progress.tell("sensors", done, steps);
        })?;
        let about = About::default();
        let sheet = study_sheet(&studies, &about);
        let notes = json!(studies.notes).to_string();
        Ok((to_json(&StudyFile { studies: &studies }), notes, sheet.text(width), sheet.html()))
    })
}
