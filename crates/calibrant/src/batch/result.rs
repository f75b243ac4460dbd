//! What comes of a batch: a row for each recording, and the copies among them.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Refusal, Result};
use calibrant_io::{Finished, HashedFile, ResumeKey, SummaryRow, calibrations_json};
use std::path::PathBuf;

/// The files of a result in its folder.
pub const RESULT_FILES: [&str; 3] = ["calibration.json", "report.html", "resume.json"];

/// The results of a batch.
#[derive(Debug)]
pub struct BatchResults {
    /// A row for each recording, in their order.
    pub rows: Vec<BatchRow>,
    /// The recordings that share a file, by their numbers. None of them was calibrated.
    pub copies: Vec<Vec<usize>>,
}

/// A recording and what came of it.
#[derive(Debug)]
pub struct BatchRow {
    /// The name of its folder.
    pub folder: String,
    /// The recording, as it was given.
    pub recording: PathBuf,
    /// Its files by their content; `None` where one cannot be read.
    pub files: Option<Vec<HashedFile>>,
    /// What its result depends on: equal keys give equal results. `None` where a file cannot be read.
    pub key: Option<ResumeKey>,
    /// Its result, or the reason why there is none.
    pub outcome: Result<BatchResult>,
    /// Has its folder a page about the error?
    pub has_failure_page: bool,
    /// What was told before an error ended the work. With a result, it is there.
    pub(super) told: Vec<Diagnostic>,
}

/// The part of a result that is kept in memory.
#[derive(Debug, Clone)]
pub struct BatchResult {
    /// What tables and pages need of it.
    pub finished: Finished,
    /// The text of `calibration.json`, where the options ask for it; otherwise empty.
    pub json: String,
    /// Did an earlier run compute it?
    pub earlier: bool,
}

impl BatchRow {
    /// What was told of it.
    #[must_use]
    pub fn told(&self) -> &[Diagnostic] {
        self.outcome.as_ref().map_or(&self.told, |result| &result.finished.told)
    }

    /// Did an interruption come before its result?
    #[must_use]
    pub fn is_interrupted(&self) -> bool {
        self.outcome.as_ref().is_err_and(|error| error.code() == Refusal::Interrupted)
    }

    /// Did an earlier run compute its result?
    #[must_use]
    pub fn is_earlier(&self) -> bool {
        self.outcome.as_ref().is_ok_and(|result| result.earlier)
    }
}

impl BatchResults {
    /// The rows of `summary.csv`.
    #[must_use]
    pub fn summary(&self) -> Vec<SummaryRow> {
        let row = |row: &BatchRow| SummaryRow {
            file: row.folder.clone(),
            recording: row.recording.display().to_string(),
            outcome: match &row.outcome {
                Ok(result) => Ok(result.finished.summary.clone()),
                Err(error) => Err(error.into()),
            },
        };
        self.rows.iter().map(row).collect()
    }

    /// The number of recordings that have no calibration, and were not interrupted.
    #[must_use]
    pub fn failed(&self) -> usize {
        self.rows.iter().filter(|row| row.outcome.is_err()).count() - self.interrupted()
    }

    /// The number of recordings that an interruption left without a result.
    #[must_use]
    pub fn interrupted(&self) -> usize {
        self.rows.iter().filter(|row| row.is_interrupted()).count()
    }

    /// All as one JSON array ([`calibrations_json`]), where the options keep the texts.
    #[must_use]
    pub fn json(&self) -> String {
        let summary = self.summary();
        let outcomes = summary.iter().zip(&self.rows).map(|(summary, row)| {
            let text = match (&summary.outcome, &row.outcome) {
                (Err(failure), _) => Err(failure),
                (Ok(_), result) => Ok(result.as_ref().map_or("", |result| result.json.as_str())),
            };
            (summary.recording.as_str(), text)
        });
        calibrations_json(outcomes)
    }
}
