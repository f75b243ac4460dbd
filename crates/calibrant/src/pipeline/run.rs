//! The pipeline, whatever the sensor.

use super::acceptance::judge;
use super::machine::MachineTask;
use super::note::Note;
use super::options::PipelineOptions;
use super::outcome::Outcome;
use super::source::Source;
use super::task::Task;
use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::error::Result;
use calibrant_io::{Experiment, HashedFile, Origin, Plan};

/// From recordings to calibrations. It holds what all recordings share, and can calibrate several at the same time.
pub struct Pipeline<'e> {
    work: Work<'e>,
    options: PipelineOptions,
    limits: Vec<AcceptanceLimit>,
    notes: Vec<Note>,
    /// What all results come from.
    origin: Origin,
}

/// The stages that a kind of experiment needs.
enum Work<'e> {
    /// A commanded motion, or holds.
    Sensors(Box<Task<'e>>),
    /// A machine whose motion is logged.
    Machine(Box<MachineTask<'e>>),
}

impl<'e> Pipeline<'e> {
    /// Prepares what all recordings share. It reads the commanded motion of a `[motion]` experiment, and machine and log of a `[machine]` one.
    ///
    /// # Errors
    /// [`Error::Experiment`](crate::Error::Experiment) where the commanded motion is missing or makes no sense, where an IMU has no `[holds]`,
    /// or where the machine cannot be read. [`Error::Recording`](crate::Error::Recording) where the log of its motion cannot be read.
    pub fn from_experiment(experiment: &'e Experiment, options: PipelineOptions) -> Result<Self> {
        let mut notes = Vec::new();
        let work = match &experiment.plan {
            Plan::Machine(plan) => {
                Work::Machine(Box::new(MachineTask::new(experiment, plan, &options, &mut notes)?))
            }
            _ => Work::Sensors(Box::new(Task::new(experiment, &options, &mut notes)?)),
        };
        let limits = options.accept.clone().unwrap_or_else(|| experiment.accept.clone());
        let origin = Origin {
            experiment: HashedFile::of(&options.experiment_file),
            motion: options.motion.as_deref().and_then(HashedFile::of),
            ..Origin::default()
        };
        Ok(Self { work, options, limits, notes, origin })
    }

    /// What was noticed in what all recordings share.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// Calibrates from one recording.
    ///
    /// # Errors
    /// As [`run_noting`](Self::run_noting).
    pub fn run(&self, source: &Source) -> Result<Outcome> {
        let mut notes = Vec::new();
        let outcome = self.run_noting(source, &mut notes)?;
        Ok(Outcome { notes, ..outcome })
    }

    /// The same; what is noticed goes to `notes`, so that it is known even where an error ends the run.
    ///
    /// # Errors
    /// [`Error::Recording`](crate::Error::Recording) where a recording cannot be read or used;
    /// [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) names the parameters that it cannot determine;
    /// [`Error::Experiment`](crate::Error::Experiment) where it contradicts the experiment, or where the validation is on the data that were calibrated from.
    pub fn run_noting(&self, source: &Source, notes: &mut Vec<Note>) -> Result<Outcome> {
        let before = notes.len();
        let named = self.options.naming.of(&source.recording)?;
        let mut outcome = match &self.work {
            Work::Sensors(task) => task.run(source, &self.options, notes),
            Work::Machine(task) => task.run(source, &self.options, notes),
        }?;
        outcome.origin = Origin {
            sensor: Some(named.sensor),
            station: named.station,
            recorded: named.recorded.or(outcome.origin.recorded),
            inputs: std::mem::take(&mut outcome.origin.inputs),
            ..self.origin.clone()
        };
        let names = [source.name(false), source.name(true)];
        let of_recording = |note: &Note| match note {
            Note::Finding { file, finding } if names.contains(file) => Some(finding.code()),
            _ => None,
        };
        let findings = notes[before..].iter().filter_map(of_recording).collect();
        judge(&mut outcome, &self.limits, findings);
        Ok(outcome)
    }
}
