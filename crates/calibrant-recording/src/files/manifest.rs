//! The manifest of a folder: which files in it this program wrote, by their checksums. So a file that somebody
//! edited is not taken for a result, and a CSV begins with its header.
//!
//! It has a line of JSON for each file that was written, and a file is ours that has the name and the checksum of a line.
//! Lines are only ever appended, so several runs may write into one folder.

use crate::files::hashed_file::{HashedFile, checksum};
use crate::files::program::program;
use serde::{Deserialize, Serialize};
use std::io::{self, Write};
use std::path::Path;

/// Its name.
const NAME: &str = ".calibrant.jsonl";

/// A file that was written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WrittenFile {
    file: String,
    sha256: String,
    program: String,
    /// The calibration with which a recording was corrected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corrected_with: Option<String>,
}

/// Enters a file into the manifest of its folder.
pub fn enter(path: &Path, sha256: String, corrected_with: Option<&str>) -> io::Result<()> {
    let Some((manifest, file)) = place(path) else { return Ok(()) };
    let entry =
        WrittenFile { file, sha256, program: program(), corrected_with: corrected_with.map(str::to_owned) };
    let mut line = serde_json::to_vec(&entry)?;
    line.push(b'\n');
    // in one piece: so lines of several runs do not mix
    std::fs::OpenOptions::new().append(true).create(true).open(manifest)?.write_all(&line)
}

/// The entry of a file that is as it was written; `None` for a file of others, or one that was edited.
pub fn entry(path: &Path) -> Option<WrittenFile> {
    let of_name = entries(path);
    let sha256 = if of_name.is_empty() { None } else { checksum(path) }?;
    of_name.into_iter().find(|entry| entry.sha256 == sha256)
}

/// A file as it was written last, without reading it again; `None` where the manifest does not have it.
pub fn as_written(path: &Path) -> Option<HashedFile> {
    let WrittenFile { file, sha256, .. } = entries(path).into_iter().next()?;
    Some(HashedFile { file, sha256 })
}

/// Has a file of this name been written, even if it was edited since?
pub fn names(path: &Path) -> bool {
    !entries(path).is_empty()
}

/// The entries of this name, the newest first.
fn entries(path: &Path) -> Vec<WrittenFile> {
    let Some((manifest, file)) = place(path) else { return Vec::new() };
    let text = std::fs::read_to_string(manifest).unwrap_or_default();
    let entries = text.lines().rev().filter_map(|line| serde_json::from_str::<WrittenFile>(line).ok());
    entries.filter(|entry| entry.file == file).collect()
}

/// The manifest of a file's folder, and the file's name in it.
fn place(path: &Path) -> Option<(std::path::PathBuf, String)> {
    Some((path.with_file_name(NAME), path.file_name()?.to_string_lossy().into_owned()))
}
