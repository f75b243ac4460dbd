//! Checks of the output directories, before the work begins.

use calibrant::error::{InputError, Refusal};
use calibrant::{Error, Result};
use std::io;
use std::path::Path;

/// Returns an error if DIR cannot become a directory, because a file has its name.
pub(crate) fn check_directory(directory: &Path) -> Result<()> {
    let Some(place) = directory.ancestors().find(|place| place.exists()) else { return Ok(()) };
    if place.is_dir() {
        return Ok(());
    }
    let reason = format!("{} is a file, not a directory", place.display());
    let source = io::Error::new(io::ErrorKind::NotADirectory, reason);
    Err(Error::Output { path: directory.to_path_buf(), source })
}

/// Refuses to replace an input file.
pub(crate) fn check_not_input(output: &Path, inputs: &[&Path]) -> Result<()> {
    if inputs.iter().any(|input| same_file(input, output)) {
        let input_error = InputError::new(
            Refusal::FileTaken,
            "this file is read, and would be replaced by the result",
            "give another name for the result",
        );
        return Err(Error::Experiment(Box::new(input_error.in_file(output))));
    }
    Ok(())
}

/// Do both paths name the same file?
pub(crate) fn same_file(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}
