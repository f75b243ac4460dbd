//! Simulates a sensor of an experiment, and a recording of it: what `calibrant simulate` writes, in memory.
//!
//! The seed draws the sensor from the spread of its datasheet. The number of the recording draws everything else: noise, poses, motion.

mod gains;
mod imu;
mod length;
mod machine;
mod machine_motion;
mod motion;
mod poses;
mod random;
mod table;

pub use motion::commanded_motion;

use crate::session::MotionSource;
use calibrant_core::budget::Budget;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::sensor::{ImuRecording, ReadingUnit, Recording, Sensor};
use calibrant_io::{
    Experiment, Plan, Truth, write_imu_recording, write_joint_log, write_json, write_motion, write_pose_log,
    write_recording,
};
use calibrant_machine::log::ReferenceLog;
use nalgebra::Vector3;
use random::Random;
use std::path::Path;

/// What is chosen of a simulation beside the experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationOptions {
    /// Seed of all random numbers; `None`: that of the experiment.
    pub seed: Option<u64>,
    /// Number of the recording, from 1. Each has its own noise, and its own random poses or motion.
    pub recording: u64,
    /// The commanded motion, or the log of a machine; `None`: a random one.
    pub motion: Option<MotionSource>,
    /// Directions of the specific force in the holds of an accelerometer that is held by hand; `None`: spread over the sphere.
    pub poses: Option<Vec<Vector3<f64>>>,
    /// What the simulation may take.
    pub budget: Budget,
}

impl Default for SimulationOptions {
    fn default() -> Self {
        Self { seed: None, recording: 1, motion: None, poses: None, budget: Budget::USUAL }
    }
}

/// A simulated recording, and the truth behind it.
#[derive(Debug, Clone)]
pub struct Simulation {
    /// The seed of its sensor.
    pub seed: u64,
    /// The recording.
    pub recording: ImuRecording,
    /// The true parameters.
    pub truth: Truth,
    /// The commanded motion, with its number of axes.
    pub motion: Option<(JerkControlledMotion, usize)>,
    /// The motion that took place, where that is another.
    pub true_motion: Option<JerkControlledMotion>,
    /// The log of a machine, with the unit of each joint.
    pub log: Option<(ReferenceLog, Vec<&'static str>)>,
    /// What was noticed.
    pub notes: Vec<Diagnostic>,
    /// What is good to know of the simulation.
    pub remarks: Vec<String>,
}

impl Simulation {
    /// One of a recording without a motion or a log.
    fn new(seed: u64, recording: impl Into<ImuRecording>, truth: Truth) -> Self {
        let recording = recording.into();
        Self {
            seed,
            recording,
            truth,
            motion: None,
            true_motion: None,
            log: None,
            notes: Vec::new(),
            remarks: Vec::new(),
        }
    }

    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> usize {
        let first = self.recording.accelerometer.as_ref().or(self.recording.gyroscope.as_ref());
        first.map_or(0, Recording::len)
    }

    /// Writes `recording.csv` and `truth.json` into a directory; and `motion.csv`, `true_motion.csv`, `joints.csv` or `poses.csv`, where there are these.
    ///
    /// # Errors
    /// [`Error::Output`] where a file cannot be written.
    pub fn write(&self, directory: &Path) -> Result<()> {
        let path = |name: &str| directory.join(name);
        if let Some((motion, axes)) = &self.motion {
            write_motion(&path("motion.csv"), motion, *axes)?;
            if let Some(happened) = &self.true_motion {
                write_motion(&path("true_motion.csv"), happened, *axes)?;
            }
        }
        write_json(&path("truth.json"), &self.truth)?;
        match &self.log {
            Some((ReferenceLog::Joints(log), units)) => write_joint_log(&path("joints.csv"), log, units)?,
            Some((ReferenceLog::Poses(log), _)) => write_pose_log(&path("poses.csv"), log)?,
            None => {}
        }
        match &self.recording {
            ImuRecording { accelerometer: Some(alone), gyroscope: None, .. } => {
                write_recording(&path("recording.csv"), alone)
            }
            both => write_imu_recording(&path("recording.csv"), both),
        }
    }
}

/// Draws a sensor from the datasheet of an experiment, and simulates a recording of it.
///
/// # Errors
/// [`Error::Experiment`] where the experiment lacks what only a simulation needs, such as noise and gains; where its holds and turns overlap; where
/// poses are given to an experiment that takes none; or where the recording is larger than the budget. [`Error::Recording`] where the log of a machine
/// cannot be used.
///
/// # Examples
/// ```
/// use calibrant::io::{Experiment, preset};
/// use calibrant::{SimulationOptions, simulate};
///
/// let experiment = Experiment::parse(preset("static-poses").expect("built in"), None)?;
/// let (one, other) = (SimulationOptions::default(), SimulationOptions { recording: 2, ..SimulationOptions::default() });
/// let (one, other) = (simulate(&experiment, &one)?, simulate(&experiment, &other)?);
/// assert_eq!(one.truth, other.truth, "one sensor");
/// assert_ne!(one.recording, other.recording, "two recordings");
/// # Ok::<(), calibrant::Error>(())
/// ```
pub fn simulate(experiment: &Experiment, options: &SimulationOptions) -> Result<Simulation> {
    let random =
        Random { seed: options.seed.unwrap_or(experiment.study.seed), recording: options.recording.max(1) };
    let takes_poses = matches!(&experiment.plan, Plan::Holds(plan) if plan.directions.is_none());
    if options.poses.is_some() && (!takes_poses || experiment.imu.is_some()) {
        let message = "option `poses` is for an accelerometer that is held by hand, in directions that [holds] does not list";
        let help = "leave it away, or see `calibrant init static-poses`";
        return Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
    }
    match (&experiment.plan, &experiment.imu) {
        (Plan::Motion(plan), _) => {
            check_simulable(&experiment.sensor)?;
            motion::simulate(experiment, plan, options, random)
        }
        (Plan::Machine(plan), _) => machine::simulate(experiment, plan, options, random),
        (Plan::Holds(plan), Some(imu)) => imu::simulate(experiment, plan, imu, options, random),
        (Plan::Holds(plan), None) => {
            check_simulable(&experiment.sensor)?;
            poses::simulate(experiment, plan, options, random)
        }
    }
}

/// Returns an error where a simulation needs a number that a calibration can do without.
fn check_simulable(sensor: &Sensor) -> Result<()> {
    let missing = |key: &str| {
        let message = format!("a simulation needs `{key}`");
        let input_error = InputError::new(Refusal::KeyMissing, message, "add it to the experiment file");
        Err(Error::experiment(input_error.about_key(format!("sensor.{key}"))))
    };
    if sensor.gain.is_none() {
        return missing("gain_counts_per_mps2");
    }
    match sensor.noise(&sensor.gain.unwrap_or_else(|| Vector3::repeat(1.0))) {
        None if sensor.unit == ReadingUnit::Counts => missing("noise_counts"),
        None => missing("noise_mps2"),
        Some(_) => Ok(()),
    }
}
