//! The recordings of a call.

use super::arguments::Arguments;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::Experiment;
use calibrant::report::number_format;
use calibrant::session::{Readings, SectionList, Source};

/// The recordings, with the gyroscope's file where there is one.
pub(super) fn sources(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<Vec<Source>> {
    let mut sources = match experiment.imu {
        Some(_) => with_gyroscopes(arguments)?,
        None => arguments.recordings.iter().map(Source::from_file).collect(),
    };
    match arguments.recordings.as_slice() {
        [_, _, ..] if arguments.together => {
            let first = sources.remove(0);
            Ok(vec![Source { further: sources, ..first }])
        }
        [_, _, ..] if arguments.residuals.is_some() => refuse(
            "--residuals is the table of one calibration, and several recordings are given",
            "calibrate one recording at a time with its table",
        ),
        _ => Ok(sources),
    }
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

fn refuse<T>(what: &str, help: &str) -> calibrant::Result<T> {
    Err(Error::experiment(InputError::new(Refusal::OptionsContradict, what, help)))
}
