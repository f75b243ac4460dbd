//! Simulated recordings, with the truth behind them.

use crate::arrays::{Numbers, as_array, vectors};
use crate::experiment::Experiment;
use crate::motion::{Log, Motion, Nodes, log, nodes};
use crate::options::budget;
use crate::recording::{Samples, samples, sensor_kind};
use crate::work::run;
use calibrant::io::to_json;
use calibrant::sensor::SensorKind;
use calibrant::{SimulationOptions, simulate as simulated};
use pyo3::prelude::*;
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;

/// A simulated recording.
#[pyclass(frozen)]
pub(crate) struct Simulation(Arc<calibrant::Simulation>);

/// Simulates a recording of an experiment.
#[pyfunction]
#[pyo3(signature = (experiment, *, motion=None, poses=None, seed=None, recording=1, force=false))]
pub(crate) fn simulate(
    py: Python<'_>,
    experiment: &Experiment,
    motion: Option<&Motion>,
    poses: Option<&[u8]>,
    seed: Option<u64>,
    recording: u64,
    force: bool,
) -> PyResult<Simulation> {
    let options = SimulationOptions {
        seed,
        recording,
        motion: motion.map(|motion| motion.0.clone()),
        poses: poses.map(vectors),
        budget: budget(force),
    };
    let experiment = experiment.clone();
    run(py, move || {
        let made = simulated(&experiment.read, &options).map_err(Experiment::placed(&experiment.file))?;
        Ok(Simulation(Arc::new(made)))
    })
}

#[pymethods]
impl Simulation {
    /// Times in s, readings, unit of a sensor.
    fn samples<'py>(&self, py: Python<'py>, sensor: &str) -> Option<Samples<'py>> {
        samples(py, &self.0.recording, sensor_kind(sensor))
    }

    /// Temperatures, °C.
    fn temperature_c<'py>(&self, py: Python<'py>) -> Option<Numbers<'py>> {
        self.0.recording.temperature_c.as_ref().map(|of| as_array(py, of))
    }

    /// The text of `truth.json`.
    fn truth(&self) -> String {
        to_json(&self.0.truth)
    }

    /// The commanded motion.
    fn motion<'py>(&self, py: Python<'py>) -> Option<Nodes<'py>> {
        self.0.motion.as_ref().map(|(motion, _)| nodes(py, motion))
    }

    /// The log of a machine.
    fn log<'py>(&self, py: Python<'py>) -> Option<Log<'py>> {
        self.0.log.as_ref().map(|(of, _)| log(py, of))
    }

    /// Its seed, what was noticed, the distance of the knots of a machine's motion, s, and the axes of the accelerometer.
    fn about(&self) -> String {
        let of = &self.0;
        let axes = of.recording[SensorKind::Accelerometer].as_ref().map_or(3, |of| of.axes());
        json!({ "seed": of.seed, "notes": of.notes, "knot_step_s": of.knot_step_s, "axes": axes }).to_string()
    }

    /// Writes the files of `calibrant simulate`.
    fn write(&self, py: Python<'_>, directory: PathBuf) -> PyResult<()> {
        let of = Arc::clone(&self.0);
        run(py, move || of.write(&directory))
    }
}
