//! Copies: recordings of a batch with the same bytes. The program cannot tell which sensor they belong to.

use super::sources::readings;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::HashedFile;
use calibrant::session::Source;
use std::collections::HashMap;
use std::path::Path;

/// For each recording a file of it, and a file of another recording with the same bytes, if there is one.
///
/// `hashed`: the [`readings`] of each recording; `None` where one cannot be read.
pub(super) fn of<'s>(
    sources: &'s [Source],
    hashed: &[Option<Vec<HashedFile>>],
) -> Vec<Option<[&'s Path; 2]>> {
    let mut same: HashMap<&str, Vec<(usize, &Path)>> = HashMap::new();
    for (number, (source, hashed)) in sources.iter().zip(hashed).enumerate() {
        for (path, hashed) in readings(source).zip(hashed.iter().flatten()) {
            same.entry(&hashed.sha256).or_default().push((number, path));
        }
    }
    let copy_of = |number: usize| {
        readings(&sources[number]).zip(hashed[number].iter().flatten()).find_map(|(path, hashed)| {
            let (_, other) = same[hashed.sha256.as_str()].iter().find(|(other, _)| *other != number)?;
            Some([path, other])
        })
    };
    (0..sources.len()).map(copy_of).collect()
}

/// A recording is not calibrated, because another has the same bytes.
pub(super) fn refusal([path, other]: [&Path; 2]) -> Error {
    let (message, help) = match path == other {
        true => ("this file is given twice".to_owned(), "give it once"),
        false => (
            format!("this is a copy of {}: of which sensor is it?", other.display()),
            "record the sensor again, or leave out the copy",
        ),
    };
    Error::recording(InputError::new(Refusal::RecordingRepeated, message, help).in_file(path))
}
