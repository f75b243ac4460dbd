//! What all recordings of a call share.

use super::arguments::Arguments;
use super::record_keeper::RecordKeeper;
use super::sources::{check_motion, sources};
use crate::diagnostics::{rules, tell_all};
use calibrant::acceptance::AcceptanceLimit;
use calibrant::diagnostic::Diagnostic;
use calibrant::io::{
    Experiment, HashedFile, Plan, ResumeKey, SensorNaming, TableFormat, UrdfSource, read_acceptance,
};
use calibrant::session::{MotionSource, Outcome, Readings, Session, SessionOptions, Source};
use std::path::{Path, PathBuf};

/// The session and its recordings.
pub(super) struct Job<'a> {
    pub(super) arguments: &'a Arguments,
    pub(super) sources: Vec<Source>,
    pub(super) experiment: &'a Experiment,
    /// The limits that a result must keep.
    pub(super) limits: Vec<AcceptanceLimit>,
    /// Where the results are recorded.
    pub(super) records: RecordKeeper,
    naming: SensorNaming,
    session: Session,
    /// What the results of all recordings depend on.
    key: Option<ResumeKey>,
}

impl<'a> Job<'a> {
    pub(super) fn prepare(arguments: &'a Arguments, experiment: &'a Experiment) -> calibrant::Result<Self> {
        check_motion(arguments, experiment)?;
        arguments.residuals.as_deref().map(TableFormat::of).transpose()?;
        let options = options(arguments)?;
        let limits = options.accept.clone().unwrap_or_else(|| experiment.accept.clone());
        let naming = options.naming.clone();
        let shared: Option<Vec<_>> = shared_files(arguments, experiment).map(HashedFile::of).collect();
        let key = shared.map(|shared| ResumeKey::of(&without_budget(&options), &shared));
        let session = Session::with(experiment.clone(), options)?;
        tell_all(session.notes());
        let sources = sources(arguments, experiment)?;
        let records = RecordKeeper::open(arguments.records.as_deref())?;
        Ok(Self { arguments, sources, experiment, limits, records, naming, session, key })
    }

    /// The key of the result of a recording with these files; `None` where a file that all recordings share cannot be read.
    pub(super) fn key(&self, files: &[HashedFile]) -> Option<ResumeKey> {
        Some(self.key.as_ref()?.with(files))
    }

    /// Refuses a recording that the records have as one of another sensor. `files`: those of its readings; `None` where one cannot be read.
    pub(super) fn check_records(
        &self,
        source: &Source,
        files: impl FnOnce() -> Option<Vec<HashedFile>>,
    ) -> calibrant::Result<()> {
        // a name that is not of the pattern is refused where the recording is calibrated
        let sensor = || Some(self.naming.of(source.recording.path()).ok()?.sensor);
        self.records.check(sensor, files).map_err(|error| error.in_recording(source.recording.path()))
    }

    /// Calibrates from a recording, writes the results and records them. Adds notes and warnings to `notes`, even if it fails.
    pub(super) fn run(
        &self,
        source: &Source,
        directory: &Path,
        notes: &mut Vec<Diagnostic>,
    ) -> calibrant::Result<Outcome> {
        let outcome = self.session.calibrate_noting(source, notes)?;
        outcome.write(directory)?;
        self.records.add(|| outcome.json())?;
        Ok(outcome)
    }
}

/// The options in words, but for what the work may take: results do not depend on that.
fn without_budget(options: &SessionOptions) -> String {
    let mut options = options.clone();
    options.reading.budget = None;
    format!("{options:?}")
}

/// The files on which all results depend.
fn shared_files<'a>(arguments: &'a Arguments, experiment: &'a Experiment) -> impl Iterator<Item = &'a Path> {
    let machine = match &experiment.plan {
        Plan::Machine(plan) => plan.source.as_ref(),
        _ => None,
    };
    let urdf = machine.and_then(|source| match &source.urdf {
        UrdfSource::File(path) => Some(path),
        UrdfSource::Preset(_) => None,
    });
    let optional = [arguments.motion.as_ref(), urdf].into_iter().flatten();
    std::iter::once(&arguments.experiment).chain(optional).map(PathBuf::as_path)
}

fn options(arguments: &Arguments) -> calibrant::Result<SessionOptions> {
    let other = |recording| Source {
        gyroscope: arguments.validate_gyroscope.as_ref().map(Readings::file),
        ..Source::from_file(recording)
    };
    Ok(SessionOptions {
        experiment_file: arguments.experiment.clone(),
        motion: arguments.motion.clone().map(MotionSource::File),
        reading: arguments.reading.options()?,
        validate: arguments.validate.as_ref().map(other),
        validate_motion: arguments.validate_motion.clone().map(MotionSource::File),
        folds: arguments.folds,
        accept: arguments.accept.as_deref().map(read_acceptance).transpose()?,
        allowed: rules().allowed().to_vec(),
        naming: arguments.naming.options()?,
        report: !arguments.no_report,
        ..SessionOptions::default()
    })
}
