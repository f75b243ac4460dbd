//! The recordings of a call, and options that need a single recording.

use super::arguments::Arguments;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{Experiment, HashedFile, Plan};
use calibrant::report::number_format;
use calibrant::session::{Readings, SectionList, Source};
use std::path::Path;

/// The recordings, with the gyroscope's file where there is one.
pub(super) fn sources(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<Vec<Source>> {
    let sources = match experiment.imu {
        Some(_) => with_gyroscopes(arguments)?,
        None => arguments.recordings.iter().map(Source::from_file).collect(),
    };
    if arguments.together {
        return together(arguments, experiment);
    }
    if sources.len() > 1 {
        check_several(arguments, experiment)?;
    }
    if arguments.records.is_some() {
        arguments.naming.check_for_records(&arguments.recordings)?;
    }
    Ok(sources)
}

/// One source of all recordings, those of one accelerometer.
fn together(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<Vec<Source>> {
    let help = "calibrate the recordings one by one, or leave out --together";
    match (&experiment.imu, &experiment.plan) {
        (None, Plan::Holds(holds)) if holds.intervals_s.is_none() => {}
        (None, Plan::Holds(_)) => {
            return refuse("--together needs holds that are found, and holds.intervals_s gives them", help);
        }
        _ => return refuse("--together is for an accelerometer and [holds]", help),
    }
    arguments.naming.check_together(&arguments.recordings)?;
    let [first, further @ ..] = arguments.recordings.as_slice() else { return Ok(Vec::new()) };
    Ok(vec![Source { further: further.iter().map(Readings::file).collect(), ..Source::from_file(first) }])
}

/// The files of a recording's readings, its own first.
pub(super) fn readings(source: &Source) -> impl Iterator<Item = &Path> {
    let readings = std::iter::once(&source.recording).chain(&source.gyroscope).chain(&source.further);
    readings.map(Readings::path)
}

/// The [`readings`] by their content; `None` where one cannot be read.
pub(super) fn hashed_readings(source: &Source) -> Option<Vec<HashedFile>> {
    readings(source).map(HashedFile::of).collect()
}

fn with_gyroscopes(arguments: &Arguments) -> calibrant::Result<Vec<Source>> {
    let (recordings, gyroscopes) = (&arguments.recordings, &arguments.gyroscope);
    if !gyroscopes.is_empty() && gyroscopes.len() != recordings.len() {
        return refuse(
            &format!(
                "{} of gyroscopes for {}",
                number_format::counted(gyroscopes.len(), "file"),
                number_format::counted(recordings.len(), "recording")
            ),
            "give --gyroscope FILE once for each recording, in their order, or not at all where the recordings have both sensors",
        );
    }
    let gyroscopes = gyroscopes.iter().map(|file| Some(Readings::file(file))).chain(std::iter::repeat(None));
    let source = |(recording, gyroscope)| Source {
        gyroscope,
        sections: arguments.sections.clone().map(SectionList::File),
        ..Source::from_file(recording)
    };
    Ok(recordings.iter().zip(gyroscopes).map(source).collect())
}

/// Refuses options for one recording where there are several.
fn check_several(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<()> {
    if arguments.validate.is_some() || arguments.folds.is_some() {
        return refuse(
            "one calibration is validated at a time, and several recordings are given",
            "give one recording with --validate or --folds",
        );
    }
    if arguments.residuals.is_some() {
        return refuse(
            "--residuals is the table of one calibration, and several recordings are given",
            "calibrate one recording at a time with its table",
        );
    }
    arguments.naming.check_several()?;
    if arguments.recordings.iter().filter(|path| path.as_os_str() == "-").count() > 1 {
        return refuse("standard input (-) is given twice", "give it once");
    }
    if experiment.imu.is_some() && arguments.sections.is_some() {
        return refuse(
            "--sections is the list of one recording, and several are given",
            "calibrate one recording at a time with its list",
        );
    }
    Ok(())
}

/// Refuses a recording that is also the commanded motion.
pub(super) fn check_motion(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<()> {
    let (Some(motion), None, Plan::Motion(_)) = (&arguments.motion, &experiment.imu, &experiment.plan) else {
        return Ok(());
    };
    match arguments.recordings.iter().find(|recording| same_file(recording, motion)) {
        Some(recording) => refuse(
            &format!("{} is both the motion and a recording", recording.display()),
            "leave it out of the recordings, or keep them in a folder of their own",
        ),
        None => Ok(()),
    }
}

fn refuse<T>(what: &str, help: &str) -> calibrant::Result<T> {
    Err(Error::experiment(InputError::new(Refusal::OptionsContradict, what, help)))
}

/// Do both paths name the same file?
fn same_file(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}
