//! The session, whatever the sensor.

use super::acceptance::judge;
use super::kind::Kind;
use super::machine::MachineTask;
use super::motion_source::MotionSource;
use super::options::SessionOptions;
use super::other_soaks::OtherSoaks;
use super::outcome::Outcome;
use super::prepared::{Prepared, unsuited};
use super::reader::Reader;
use super::source::Source;
use super::task::Task;
use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::Result;
use calibrant_io::{Experiment, HashedFile, ImuFile, Origin, Plan, ResumeKey, UrdfSource};

/// From recordings to calibrations, in files or in memory. It holds what all recordings share, and can calibrate several at the same time.
pub struct Session {
    experiment: Experiment,
    options: SessionOptions,
    prepared: Prepared,
    notes: Vec<Diagnostic>,
    /// What all results come from.
    origin: Origin,
    others: OtherSoaks,
}

impl Session {
    /// A session of an experiment that needs nothing else: the sensor is held still, or a machine's log is in the file of each recording.
    ///
    /// # Errors
    /// As [`with`](Self::with).
    pub fn new(experiment: Experiment) -> Result<Self> {
        Self::with(experiment, SessionOptions::default())
    }

    /// Prepares what all recordings share. It reads the commanded motion of a `[motion]` experiment, and machine and log of a `[machine]` one.
    ///
    /// # Errors
    /// [`Error::Experiment`](crate::Error::Experiment) where the commanded motion is missing or makes no sense, where an IMU has no `[holds]`,
    /// or where the machine cannot be read. [`Error::Recording`](crate::Error::Recording) where the log of its motion cannot be read.
    pub fn with(experiment: Experiment, options: SessionOptions) -> Result<Self> {
        options.naming.check()?;
        let mut notes = Vec::new();
        let prepared = Prepared::read(&experiment, &options, &mut notes)?;
        let origin = Origin {
            experiment: Some(experiment.origin()),
            motion: options.motion.as_ref().and_then(MotionSource::hashed),
            ..Origin::default()
        };
        Ok(Self { experiment, options, prepared, notes, origin, others: OtherSoaks::default() })
    }

    /// The same for a soak of a campaign of which other soaks are calibrated already.
    #[must_use]
    pub fn beside(self, others: OtherSoaks) -> Self {
        Self { others, ..self }
    }

    /// The experiment.
    #[must_use]
    pub fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// What the caller chose.
    #[must_use]
    pub fn options(&self) -> &SessionOptions {
        &self.options
    }

    /// What all results depend on: program, options, experiment, commanded motion or log, and machine. With the files of a recording
    /// ([`ResumeKey::with`]) it is the key of a result. `None` where a file cannot be read.
    #[must_use]
    pub fn key(&self) -> Option<ResumeKey> {
        let (options, experiment) = (&self.options, &self.experiment);
        let mut files = vec![experiment.origin()];
        if options.motion.is_some() {
            files.push(self.origin.motion.clone()?);
        }
        let machine = match &experiment.plan {
            Plan::Machine(plan) => plan.urdf.as_ref(),
            _ => None,
        };
        if let Some(UrdfSource::File(path)) = machine {
            files.push(HashedFile::of(path)?);
        }
        Some(ResumeKey::of(&options.in_words(), &files))
    }

    /// The limits that a result must keep: those of the options, or of the experiment.
    #[must_use]
    pub fn limits(&self) -> &[AcceptanceLimit] {
        self.options.accept.as_ref().unwrap_or(&self.experiment.accept)
    }

    /// What was noticed in what all recordings share.
    #[must_use]
    pub fn notes(&self) -> &[Diagnostic] {
        &self.notes
    }

    /// A recording as it is read: its samples, columns and units, and what was noticed.
    ///
    /// # Errors
    /// [`Error::Recording`](crate::Error::Recording) where it cannot be read, or leaves open what its columns are.
    pub fn read(&self, source: &Source) -> Result<ImuFile> {
        Reader::of(&self.experiment, &self.options).file(source)
    }

    /// Calibrates from one recording: reads, cleans, finds holds and noise, estimates, validates, judges.
    ///
    /// # Errors
    /// As [`calibrate_noting`](Self::calibrate_noting).
    pub fn calibrate(&self, source: &Source) -> Result<Outcome> {
        let mut notes = Vec::new();
        let outcome = self.calibrate_noting(source, &mut notes)?;
        Ok(Outcome { notes, ..outcome })
    }

    /// The same; what is noticed goes to `notes`, so that it is known even where an error ends the work.
    ///
    /// # Errors
    /// [`Error::Recording`](crate::Error::Recording) where a recording cannot be read or used;
    /// [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) names the parameters that it cannot determine;
    /// [`Error::Experiment`](crate::Error::Experiment) where it contradicts the experiment, or where the validation is on the data that were calibrated from.
    pub fn calibrate_noting(&self, source: &Source, notes: &mut Vec<Diagnostic>) -> Result<Outcome> {
        let before = notes.len();
        let named = self.options.naming.of(source.path())?;
        let mut outcome = self.estimated(source, notes)?;
        outcome.about.of_thesis = self.experiment.is_of_thesis();
        outcome.origin = Origin {
            sensor: Some(named.sensor),
            station: named.station,
            recorded: named.recorded.or(outcome.origin.recorded),
            inputs: std::mem::take(&mut outcome.origin.inputs),
            ..self.origin.clone()
        };
        let names = [source.name(false), source.name(true)];
        let is_of_recording =
            |found: &&Diagnostic| found.file().is_some_and(|file| names.iter().any(|name| name == file));
        let findings = notes[before..].iter().filter(is_of_recording).map(Diagnostic::code).collect();
        judge(&mut outcome, self.limits(), findings);
        Ok(outcome)
    }

    /// The stages that this kind of experiment needs, up to the validation.
    fn estimated(&self, source: &Source, notes: &mut Vec<Diagnostic>) -> Result<Outcome> {
        let (experiment, options) = (&self.experiment, &self.options);
        let kind = match (&experiment.plan, &self.prepared) {
            (Plan::Machine(plan), Prepared::OnMachine { chain, log }) => {
                let given = (chain.as_ref(), log.as_deref());
                return MachineTask::new(experiment, plan, given, options).run(source, options, notes);
            }
            (Plan::Holds(holds), _) => Kind::held(holds, experiment.imu.as_ref()),
            (Plan::Motion(_), Prepared::Moved(command)) => Kind::Motion(command),
            (Plan::Motion(_) | Plan::Machine(_), _) => return Err(unsuited()),
        };
        Task::new(experiment, kind, options, &self.others).run(source, options, notes)
    }
}
