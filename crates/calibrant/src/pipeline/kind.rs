//! The kinds of calibrations: what an experiment says of the motion in every recording.

use super::note::Note;
use super::options::PipelineOptions;
use super::sections::{setup_of, unused_face_sd};
use super::setup::{Faces, Setup};
use super::source::Source;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::CommandedMotion;
use calibrant_core::sensor::ImuRecording;
use calibrant_io::{Experiment, HoldsPlan, ImuPlan, MotionPlan, Plan, read_motion};

/// A kind of calibration.
pub(crate) enum Kind<'e> {
    /// An accelerometer on a commanded motion.
    Motion(CommandedMotion),
    /// An accelerometer that is held still.
    Holds(&'e HoldsPlan),
    /// An IMU that is held still and turned.
    Imu(&'e ImuPlan, &'e HoldsPlan),
}

impl<'e> Kind<'e> {
    /// That of an experiment. Reads the commanded motion of a `[motion]` experiment.
    pub(crate) fn of(
        experiment: &'e Experiment,
        options: &PipelineOptions,
        notes: &mut Vec<Note>,
    ) -> Result<Self> {
        match (&experiment.imu, &experiment.plan) {
            (None, Plan::Motion(plan)) => Ok(Self::Motion(commanded(plan, experiment, options, notes)?)),
            (None, Plan::Holds(holds)) => Ok(Self::Holds(holds)),
            (Some(imu), Plan::Holds(holds)) => Ok(Self::Imu(imu, holds)),
            (Some(_), Plan::Motion(_)) | (_, Plan::Machine(_)) => {
                let help = "see `calibrant init imu`";
                Err(Error::experiment(InputError::new(
                    Refusal::ExperimentUnsuited,
                    "an IMU needs [holds]",
                    help,
                )))
            }
        }
    }

    /// What the recording lacks of this kind.
    pub(crate) fn missing(&self, recording: &ImuRecording) -> Vec<Diagnostic> {
        let without = matches!(self, Self::Imu(..)) && recording.gyroscope.is_none();
        without.then_some(Diagnostic::GyroscopeMissing {}).into_iter().collect()
    }

    /// What is known of one recording.
    pub(crate) fn setup(
        &self,
        source: &Source,
        recording: &ImuRecording,
        notes: &mut Vec<Note>,
    ) -> Result<Setup<'e>> {
        Ok(match self {
            Self::Motion(command) => Setup::Motion(command.clone()),
            Self::Holds(plan) => held(plan, notes),
            // it cannot be lost unnoticed: the calibration gets a diagnostic
            Self::Imu(_, plan) if recording.gyroscope.is_none() => held(plan, notes),
            Self::Imu(plan, holds) => {
                Setup::Imu(&plan.gyroscope, Box::new(setup_of(plan, holds, source, recording, notes)?))
            }
        })
    }
}

/// An accelerometer that is held still.
fn held<'e>(plan: &'e HoldsPlan, notes: &mut Vec<Note>) -> Setup<'e> {
    match &plan.directions {
        Some(directions) => {
            Setup::Faces(Faces { holds: plan.setup(), directions, face_sd_rad: plan.face_sd_rad })
        }
        None => {
            notes.extend(unused_face_sd(plan.face_sd_rad));
            Setup::Holds(plan.setup())
        }
    }
}

/// The commanded motion of a `[motion]` experiment.
fn commanded(
    plan: &MotionPlan,
    experiment: &Experiment,
    options: &PipelineOptions,
    notes: &mut Vec<Note>,
) -> Result<CommandedMotion> {
    let path = options.motion.as_deref().ok_or_else(|| {
        Error::experiment(InputError::new(
            Refusal::KeyMissing,
            "a [motion] experiment needs the commanded motion",
            "add --motion FILE with columns t_s,ax_mps2,ay_mps2,az_mps2 at the nodes; trust unknown uses only its first and last row",
        ))
    })?;
    let motion = read_motion(path, experiment.sensor.axes)?;
    if motion.intervals() != plan.intervals {
        notes.push(Note::Remark(format!(
            "{} has {} intervals, the experiment file {}: the former counts",
            path.display(),
            motion.intervals(),
            plan.intervals
        )));
    }
    Ok(plan.command(motion))
}
