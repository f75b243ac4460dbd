//! Recordings of a batch that are copies of each other: nobody knows of which sensor they are.

use super::parallel::in_parallel;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::ResumeKey;
use std::path::{Path, PathBuf};

/// For each recording the number of another one with the same bytes, if there is one.
pub(super) fn of(recordings: &[PathBuf]) -> Vec<Option<usize>> {
    let contents = in_parallel(recordings.len(), |number| ResumeKey::of("", [recordings[number].as_path()]));
    let other = |number: usize| {
        let own = contents[number].as_ref()?;
        (0..contents.len()).find(|&other| other != number && contents[other].as_ref() == Some(own))
    };
    (0..recordings.len()).map(other).collect()
}

/// A recording is not calibrated, because another has the same bytes.
pub(super) fn refusal(path: &Path, other: &Path) -> Error {
    let message = format!("this is a copy of {}: of which sensor is it?", other.display());
    let help = "record the sensor again, or leave out the copy";
    Error::recording(InputError::new(Refusal::RecordingRepeated, message, help).in_file(path))
}
