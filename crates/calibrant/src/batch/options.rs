//! What the caller of a batch chooses.

use std::path::PathBuf;

/// What is done with the results of a batch.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BatchOptions {
    /// Where each result gets a folder of its own, and a single one is written. `None`: nothing is written.
    pub directory: Option<PathBuf>,
    /// Are results in the directory taken over that are of the same recordings, experiment, options and version?
    pub resume: bool,
    /// Do the rows keep the text of `calibration.json`?
    pub keep_json: bool,
    /// The records to which each result is added: an SQLite database, which is made where there is none.
    pub records: Option<PathBuf>,
}
