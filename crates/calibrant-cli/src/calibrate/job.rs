//! The arguments as the library takes them.

use super::arguments::Arguments;
use super::sources::sources;
use crate::diagnostics::{rules, tell_all};
use crate::interruption;
use calibrant::batch::{Batch, BatchOptions};
use calibrant::io::{Experiment, TableFormat, read_acceptance};
use calibrant::session::{MotionSource, Readings, Session, SessionOptions, Source};

/// The recordings of a call and what they share.
pub(super) fn batch(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<Batch> {
    batch_with(options(arguments)?, arguments, experiment)
}

/// The same with other options for each recording.
pub(super) fn batch_with(
    mut session_options: SessionOptions,
    arguments: &Arguments,
    experiment: &Experiment,
) -> calibrant::Result<Batch> {
    arguments.residuals.as_deref().map(TableFormat::of).transpose()?;
    let sources = sources(arguments, experiment)?;
    if sources.len() > 1 {
        session_options.interruption = interruption::keeping_the_best();
    }
    let session = Session::with(experiment.clone(), session_options)?;
    tell_all(session.notes());
    let options = BatchOptions {
        directory: Some(arguments.output.clone()),
        resume: arguments.resume,
        keep_json: arguments.json || experiment.campaign_section().is_some(),
        records: arguments.records.clone(),
    };
    Batch::new(session, sources, options)
}

pub(super) fn options(arguments: &Arguments) -> calibrant::Result<SessionOptions> {
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
