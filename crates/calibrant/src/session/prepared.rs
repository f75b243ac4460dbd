//! What all recordings of a session share beside the experiment: the commanded motion, or the machine and its log.

use super::machine_log::LogFile;
use super::options::SessionOptions;
use calibrant_core::diagnostic::motion::IntervalsDiffer;
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::{Error, InputError, Refusal, Result, TaskOption};
use calibrant_core::motion::CommandedMotion;
use calibrant_io::{Experiment, MotionPlan, Plan};
use calibrant_machine::chain::KinematicChain;

/// What is read once.
pub(crate) enum Prepared {
    /// Nothing: the sensor is held still.
    Held,
    /// The commanded motion.
    Moved(CommandedMotion),
    /// The machine, and the log that the options name. Without it, each recording's file has one.
    OnMachine { chain: Option<KinematicChain>, log: Option<Box<LogFile>> },
}

impl Prepared {
    pub(crate) fn read(
        experiment: &Experiment,
        options: &SessionOptions,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        match &experiment.plan {
            Plan::Motion(plan) if experiment.imu.is_none() => {
                Ok(Self::Moved(commanded(plan, experiment, options, notes)?))
            }
            Plan::Motion(_) => Err(unsuited()),
            Plan::Holds(_) => Ok(Self::Held),
            Plan::Machine(plan) => {
                let log = options.motion.as_ref();
                Ok(Self::OnMachine {
                    chain: plan.kinematic_chain()?,
                    log: log
                        .map(|log| LogFile::read(log, &plan.log_options(), notes))
                        .transpose()?
                        .map(Box::new),
                })
            }
        }
    }
}

/// The error about a plan that is not of the sensors.
pub(crate) fn unsuited() -> Error {
    let (message, help) = ("an IMU needs [holds]", "see `calibrant init imu`");
    Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help))
}

/// The commanded motion of a `[motion]` experiment.
fn commanded(
    plan: &MotionPlan,
    experiment: &Experiment,
    options: &SessionOptions,
    notes: &mut Vec<Diagnostic>,
) -> Result<CommandedMotion> {
    let source = options.motion.as_ref().ok_or_else(|| {
        let message = "a [motion] experiment needs the commanded motion";
        let help = "add option `motion` FILE with columns t_s,ax_mps2,ay_mps2,az_mps2 at the nodes; trust unknown uses only its first and last row";
        Error::experiment(InputError::new(Refusal::KeyMissing, message, help).answered_by(TaskOption::Motion, []))
    })?;
    let motion = source.commanded(experiment.sensor.axes)?;
    if motion.intervals() != plan.intervals {
        let name = Phrase(source.path().display().to_string());
        let (intervals, stated) = (motion.intervals(), plan.intervals);
        notes.push(IntervalsDiffer { motion: name, intervals, stated }.into());
    }
    Ok(plan.command(motion))
}
