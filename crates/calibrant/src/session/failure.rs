//! The page about a recording that could not be calibrated: the error, and what the recording contains.

use super::reader::Reader;
use super::run::Session;
use super::source::Source;
use crate::inspection::recording_sheet;
use calibrant_core::error::Error;
use calibrant_io::{file_name, inspect};
use calibrant_report::{Grade, Sheet, SheetVerdict};
use std::path::Path;

impl Session {
    /// The text of `report.html` where this recording ended in an error: the error, the readings over time, what is at rest and why some of it is no hold. `None` where the
    /// recording cannot be read.
    #[must_use]
    pub fn failure_html(&self, source: &Source, error: &Error) -> Option<String> {
        // an error about another file than this recording has no page
        let names = [source.name(false), source.name(true)];
        let is_other = |file: &Path| !names.contains(&file_name(file));
        let of_other = match error {
            Error::Recording(found) | Error::Experiment(found) => found.file.as_deref().is_some_and(is_other),
            _ => false,
        };
        if of_other || !source.further.is_empty() {
            return None;
        }
        let file = Reader::of(self.experiment(), self.options()).file(source).ok()?;
        let names: Vec<String> = source.paths().map(|path| path.display().to_string()).collect();
        let inspection = inspect(&file);
        let sheet = recording_sheet(&file, &inspection, &names);
        let verdict = SheetVerdict::new(Grade::Bad, "✗ Not calibrated:", error.to_string());
        let footer = vec![format!("calibrant {}.", env!("CARGO_PKG_VERSION"))];
        Some(Sheet { verdict: Some(verdict), footer, ..sheet }.html())
    }
}
