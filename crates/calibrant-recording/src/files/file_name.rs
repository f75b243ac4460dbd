//! The name by which results call a file.

use std::path::Path;

/// Name of a file, without its directory.
#[must_use]
pub fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
