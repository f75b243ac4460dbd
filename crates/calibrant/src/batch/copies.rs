//! Copies: recordings with the same bytes. The program cannot tell which sensor they belong to.

use calibrant_core::error::{Error, InputError, Refusal};
use calibrant_io::HashedFile;
use std::collections::HashMap;
use std::path::Path;

/// The files of many recordings by their content.
///
/// # Examples
/// ```
/// use calibrant::batch::Copies;
/// use calibrant::io::HashedFile;
///
/// let [a, b, copy] = ["1", "2", "1"].map(|bytes| Some(vec![HashedFile::of_bytes("rec.csv", bytes.as_bytes())]));
/// assert_eq!(Copies::among(&[a, None, b, copy]).groups(), [[0, 3]]);
/// ```
#[derive(Debug)]
pub struct Copies<'h> {
    files: &'h [Option<Vec<HashedFile>>],
    /// By its checksum: where each file stands, as the number of the recording and that of the file.
    places: HashMap<&'h str, Vec<(usize, usize)>>,
}

impl<'h> Copies<'h> {
    /// Compares the files of recordings; `None` where one cannot be read.
    #[must_use]
    pub fn among(files: &'h [Option<Vec<HashedFile>>]) -> Self {
        let mut places: HashMap<&str, Vec<(usize, usize)>> = HashMap::new();
        for (number, files) in files.iter().enumerate() {
            for (k, file) in files.iter().flatten().enumerate() {
                places.entry(&file.sha256).or_default().push((number, k));
            }
        }
        Self { files, places }
    }

    /// The recordings that share a file, by their numbers: each group in order, the groups by their first.
    #[must_use]
    pub fn groups(&self) -> Vec<Vec<usize>> {
        let numbers = |places: &Vec<(usize, usize)>| {
            let mut numbers: Vec<usize> = places.iter().map(|(number, _)| *number).collect();
            numbers.dedup();
            numbers
        };
        let mut groups: Vec<_> = self.places.values().map(numbers).filter(|group| group.len() > 1).collect();
        groups.sort();
        groups.dedup();
        groups
    }

    /// Why a recording is not calibrated: another has the bytes of one of its files. `path_of`: the path of a file, by its place.
    pub(super) fn refusal<'p>(
        &self,
        number: usize,
        path_of: impl Fn((usize, usize)) -> Option<&'p Path>,
    ) -> Option<Error> {
        let of_others = |(k, file): (usize, &HashedFile)| {
            let other = self.places[file.sha256.as_str()].iter().find(|(other, _)| *other != number)?;
            path_of((number, k)).zip(path_of(*other))
        };
        let (path, other) = self.files[number].iter().flatten().enumerate().find_map(of_others)?;
        let (message, help) = match path == other {
            true => ("this file is given twice".to_owned(), "give it once"),
            false => (
                format!("this is a copy of {}: of which sensor is it?", other.display()),
                "record the sensor again, or leave out the copy",
            ),
        };
        let error = InputError::new(Refusal::RecordingRepeated, message, help);
        Some(Error::recording(error.in_file(path)))
    }
}
