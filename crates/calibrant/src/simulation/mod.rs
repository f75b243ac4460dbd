//! Simulates a sensor of an experiment, and a recording of it: what `calibrant simulate` writes, in memory.
//!
//! The seed draws the sensor from the spread of its datasheet. The number of the recording draws everything else: noise, poses, motion.

mod campaign;
mod gains;
mod imu;
mod length;
mod machine;
mod machine_motion;
mod motion;
mod noise;
mod options;
mod poses;
mod random;
mod simulated;
mod table;

pub use campaign::{SimulatedCampaign, simulate_campaign};
pub use motion::commanded_motion;
pub use options::SimulationOptions;
pub use simulated::Simulation;

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{ReadingUnit, Sensor};
use calibrant_io::{Experiment, Plan};
use nalgebra::Vector3;
use random::Random;

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
    if options.poses.as_ref().is_some_and(Vec::is_empty) {
        let input_error =
            InputError::new(Refusal::HoldsInvalid, "option `poses` has no pose", "give one or more");
        return Err(Error::experiment(input_error));
    }
    if options.poses.is_some() && !takes_poses {
        let message =
            "option `poses` is for a sensor that is held by hand, in directions that [holds] does not list";
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
            check_simulable(experiment.sensor.with_usual_noise().as_ref().unwrap_or(&experiment.sensor))?;
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
