//! What all recordings of a call share.

use super::arguments::{Arguments, Unit};
use super::sources::{check_motion, sources};
use crate::console;
use calibrant::io::{Experiment, read_acceptance};
use calibrant::pipeline::{Note, Outcome, Pipeline, PipelineOptions, Source};
use calibrant::sensor::ReadingUnit;
use std::path::Path;

/// The pipeline and its recordings.
pub(super) struct Job<'a> {
    pub(super) arguments: &'a Arguments,
    pub(super) sources: Vec<Source>,
    pub(super) experiment: &'a Experiment,
    pipeline: Pipeline<'a>,
}

impl<'a> Job<'a> {
    pub(super) fn prepare(arguments: &'a Arguments, experiment: &'a Experiment) -> calibrant::Result<Self> {
        check_motion(arguments, experiment)?;
        let pipeline = Pipeline::from_experiment(experiment, options(arguments)?)?;
        pipeline.notes().iter().for_each(console::noted);
        let sources = sources(arguments, experiment)?;
        Ok(Self { arguments, sources, experiment, pipeline })
    }

    /// Calibrates from a recording and writes the results. Adds notes and warnings to `notes`, even if it fails.
    pub(super) fn run(
        &self,
        source: &Source,
        directory: &Path,
        notes: &mut Vec<Note>,
    ) -> calibrant::Result<Outcome> {
        let outcome = self.pipeline.run_noting(source, notes)?;
        outcome.write(directory)?;
        Ok(outcome)
    }
}

fn options(arguments: &Arguments) -> calibrant::Result<PipelineOptions> {
    let other = |recording| Source {
        gyroscope: arguments.validate_gyroscope.clone(),
        ..Source::from_file(recording)
    };
    Ok(PipelineOptions {
        experiment_file: arguments.experiment.clone(),
        motion: arguments.motion.clone(),
        reading: arguments.reading.options(),
        unit: arguments.unit.map(|unit| match unit {
            Unit::Mps2 => ReadingUnit::MetrePerSecondSquared,
            Unit::Counts => ReadingUnit::Counts,
        }),
        validate: arguments.validate.as_ref().map(other),
        validate_motion: arguments.validate_motion.clone(),
        folds: arguments.folds,
        accept: arguments.accept.as_deref().map(read_acceptance).transpose()?,
        allowed: arguments.rules.allowed().to_vec(),
        report: !arguments.no_report,
    })
}
