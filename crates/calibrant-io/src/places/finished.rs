//! `resume.json`: what a batch keeps of a finished recording, so that another run need not calibrate it again.
//!
//! It is written after the results, and has their checksums. So a result that another run has replaced is not taken for that of this key.

use super::resume_key::ResumeKey;
use crate::results::json::write_json;
use crate::results::summary::Summary;
use calibrant_core::diagnostic::files::ResumeDamaged;
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::Result;
use calibrant_recording::files::hashed_file::{HashedFile, checksum};
use calibrant_recording::files::manifest;
use calibrant_recording::files::program::program;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The name of the file.
pub(super) const NAME: &str = "resume.json";
/// The results that stand beside it, where they were written.
const RESULTS: [&str; 2] = ["calibration.json", "report.html"];

/// What tables and pages of a batch need of a recording that is calibrated.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Finished {
    /// Its line of `summary.csv`.
    #[serde(flatten)]
    pub summary: Summary,
    /// Its cells in the table of the terminal.
    pub cells: Vec<String>,
    /// What was told of it.
    pub told: Vec<Diagnostic>,
    /// The sensor, as `calibration.json` names it.
    pub sensor: Option<String>,
    /// Where it was recorded.
    pub station: Option<String>,
    /// When it was recorded.
    pub recorded: Option<String>,
}

/// The content of the file.
#[derive(Serialize, Deserialize)]
struct Content<F> {
    program: String,
    key: String,
    results: Vec<HashedFile>,
    #[serde(flatten)]
    finished: F,
}

impl Finished {
    /// Writes `resume.json` beside the results in this directory. `report`: has it a `report.html` of this run?
    ///
    /// # Errors
    /// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
    pub fn write(&self, directory: &Path, key: &ResumeKey, report: bool) -> Result<()> {
        let results = RESULTS.into_iter().filter(|name| report || *name != "report.html");
        let hashed = |path: PathBuf| manifest::as_written(&path).or_else(|| HashedFile::of(&path));
        let content = Content {
            program: program(),
            key: key.0.clone(),
            results: results.filter_map(|name| hashed(directory.join(name))).collect(),
            finished: self,
        };
        write_json(&directory.join(NAME), &content)
    }

    /// What an earlier run kept in this directory, with the text of `calibration.json`. `None` where it has another key, or where a result is
    /// missing or has changed since; also where `resume.json` cannot be read, which is noted.
    pub fn read(directory: &Path, key: &ResumeKey, notes: &mut Vec<Diagnostic>) -> Option<(Self, String)> {
        let path = directory.join(NAME);
        let Ok(content) = serde_json::from_slice::<Content<Self>>(&std::fs::read(&path).ok()?) else {
            notes.push(ResumeDamaged { file: Phrase(path.display().to_string()) }.into());
            return None;
        };
        let unchanged = |of: &HashedFile| {
            RESULTS.contains(&of.file.as_str())
                && checksum(&directory.join(&of.file)).as_ref() == Some(&of.sha256)
        };
        if content.key != key.0 || content.results.is_empty() || !content.results.iter().all(unchanged) {
            return None;
        }
        let json = std::fs::read_to_string(directory.join(RESULTS[0])).ok()?;
        Some((content.finished, json))
    }
}
