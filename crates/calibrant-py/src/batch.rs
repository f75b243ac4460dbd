//! Many recordings in one call: a chunk of a fleet. Each gives a row of the data set, or its error.

use crate::experiment::Experiment;
use crate::failure::{as_json, internal_error, raised};
use crate::motion::Motion;
use crate::options::{Calibrate, budget, parsed};
use crate::source::Source;
use crate::work::{How, Run, pool, run, run_as, words_of};
use calibrant::batch::in_parallel;
use calibrant::records::DatasetRow;
use calibrant::session::{MotionSource, Readings, Session, SessionOptions, Source as GivenSource};
use calibrant::{Result, SimulationOptions, simulate};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A row of the data set as JSON, or an error as JSON.
type Row = (Option<String>, Option<String>);

/// Calibrates from each recording. Copies are calibrated, too: a chunk does not know the others.
#[pyfunction]
#[pyo3(signature = (experiment, sources, options, *, motion=None, threads=None))]
pub(crate) fn calibrate_each(
    py: Python<'_>,
    experiment: &Experiment,
    sources: Vec<PyRef<'_, Source>>,
    options: &str,
    motion: Option<&Motion>,
    threads: Option<usize>,
) -> PyResult<Vec<Row>> {
    let options = options_of(options, motion).map_err(|error| raised(py, &error))?;
    let sources: Vec<_> = sources.iter().map(|source| source.0.clone()).collect();
    let experiment = experiment.clone();
    run_as(py, How { threads, ..How::default() }, move |given| {
        let options = SessionOptions { interruption: given.interruption.clone(), ..options };
        let session = Session::with(experiment.read, options)?;
        each(sources.len(), &given, |number| {
            DatasetRow::parse(&session.calibrate(&sources[number])?.json()).map(|row| json!(row))
        })
    })
}

/// Draws a sensor of each seed, simulates its recording, and calibrates from it. The row has the true value of each parameter, too.
#[pyfunction]
#[pyo3(signature = (experiment, sensors, options, *, motion=None, threads=None))]
pub(crate) fn study_each(
    py: Python<'_>,
    experiment: &Experiment,
    sensors: Vec<(String, u64)>,
    options: &str,
    motion: Option<&Motion>,
    threads: Option<usize>,
) -> PyResult<Vec<Row>> {
    let options = options_of(options, motion).map_err(|error| raised(py, &error))?;
    let experiment = experiment.clone();
    run_as(py, How { threads, ..How::default() }, move |given| {
        let options = SessionOptions { interruption: given.interruption.clone(), ..options };
        each(sensors.len(), &given, |number| {
            let (name, seed) = &sensors[number];
            simulated(&experiment, name, *seed, &options)
        })
    })
}

fn simulated(experiment: &Experiment, name: &str, seed: u64, options: &SessionOptions) -> Result<Value> {
    let drawn = SimulationOptions {
        seed: Some(seed),
        motion: options.motion.clone(),
        budget: budget(false),
        ..SimulationOptions::default()
    };
    let made = simulate(&experiment.read, &drawn).map_err(Experiment::placed(&experiment.file))?;
    let commanded = made.motion.map(|(motion, _)| MotionSource::Commanded(motion));
    let logged = made.log.map(|(log, _)| match made.knot_step_s {
        Some(step_s) => MotionSource::OnKnots(log, step_s),
        None => MotionSource::Logged(log),
    });
    let options = SessionOptions { motion: commanded.or(logged), ..options.clone() };
    let session = Session::with(experiment.read.clone(), options)?;
    let source = GivenSource::new(Readings::recording(name, made.recording));
    let row = DatasetRow::parse(&session.calibrate(&source)?.json())?;
    let truth: Vec<_> = row.names.iter().map(|name| made.truth.value(name)).collect();
    let mut row = json!(row);
    (row["truth"], row["seed"]) = (json!(truth), json!(seed));
    Ok(row)
}

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
    let options = options_of(options, motion).map_err(|error| raised(py, &error))?;
    let sources: Vec<_> = sources.iter().map(|source| source.0.clone()).collect();
    let experiment = experiment.clone();
    run(py, move || {
        let session = Session::with(experiment.read, options)?;
        let shared = session.key();
        let key = |source: &GivenSource| Some(shared.as_ref()?.with(&source.hashed()?).as_str().to_owned());
        Ok(in_parallel(sources.len(), |number| key(&sources[number])))
    })
}

/// The hash of each recording; `None` where a file cannot be read.
#[pyfunction]
pub(crate) fn hashes(py: Python<'_>, sources: Vec<PyRef<'_, Source>>) -> PyResult<Vec<Option<String>>> {
    let sources: Vec<_> = sources.iter().map(|source| source.0.clone()).collect();
    run(py, move || {
        let hash = |source: &GivenSource| {
            let files = source.hashed()?;
            Some(files.into_iter().map(|file| file.sha256).collect::<Vec<_>>().join(" "))
        };
        Ok(sources.iter().map(hash).collect())
    })
}

fn options_of(text: &str, motion: Option<&Motion>) -> Result<SessionOptions> {
    let motion = motion.map(|motion| motion.0.clone());
    Ok(SessionOptions { motion, ..parsed::<Calibrate>(text)?.options()? })
}

/// The rows of `count` items, several at the same time. An item that fails does not stop the others. An interruption does.
fn each(count: usize, given: &Run, of: impl Fn(usize) -> Result<Value> + Sync) -> Result<Vec<Row>> {
    // the threads of `in_parallel` are of no pool, and the global one would hang a process after `fork`
    let threads = (rayon::current_num_threads() / count.max(1)).max(1);
    let alone = |number: usize| -> std::result::Result<Result<Value>, String> {
        let pool = pool(threads).map_err(|error| error.to_string())?;
        catch_unwind(AssertUnwindSafe(|| pool.install(|| of(number))))
            .map_err(|panic| words_of(panic.as_ref()))
    };
    let row = |number: usize| -> Result<Row> {
        given.interruption.check()?;
        let found = alone(number);
        Ok(match found {
            Ok(Ok(row)) => (Some(row.to_string()), None),
            Ok(Err(error)) => (None, Some(as_json(&error).to_string())),
            Err(panic) => (None, Some(internal_error(&panic).to_string())),
        })
    };
    in_parallel(count, row).into_iter().collect()
}
