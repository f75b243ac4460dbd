//! Where results go: looked at before the work is done.

use calibrant::{Error, Result};
use std::io;
use std::path::Path;

/// Complains where DIR is no directory and cannot become one, because a file is in the way.
pub(crate) fn check_directory(directory: &Path) -> Result<()> {
    let Some(place) = directory.ancestors().find(|place| place.exists()) else { return Ok(()) };
    if place.is_dir() {
        return Ok(());
    }
    let reason = format!("{} is a file, not a directory", place.display());
    let source = io::Error::new(io::ErrorKind::NotADirectory, reason);
    Err(Error::Output { path: directory.to_path_buf(), source })
}
