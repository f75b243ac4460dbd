//! Copies: recordings of a batch with the same bytes. The program cannot tell which sensor they belong to.

use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::HashedFile;
use std::path::Path;

/// For each recording the number of another one with the same bytes, if there is one.
///
/// `files`: those of each recording, its own first; `None` where one cannot be read.
pub(super) fn of(files: &[Option<Vec<HashedFile>>]) -> Vec<Option<usize>> {
    let content = |number: usize| files[number].as_ref()?.first().map(|own| own.sha256.as_str());
    let other = |number: usize| {
        let own = content(number)?;
        (0..files.len()).find(|&other| other != number && content(other) == Some(own))
    };
    (0..files.len()).map(other).collect()
}

/// A recording is not calibrated, because another has the same bytes.
pub(super) fn refusal(path: &Path, other: &Path) -> Error {
    let message = format!("this is a copy of {}: of which sensor is it?", other.display());
    let help = "record the sensor again, or leave out the copy";
    Error::recording(InputError::new(Refusal::RecordingRepeated, message, help).in_file(path))
}
