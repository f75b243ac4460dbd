//! A recording of a batch: it is calibrated, or its result is taken over from an earlier run.

use super::job::Job;
use super::quality;
use calibrant::Error;
use calibrant::diagnostic::Diagnostic;
use calibrant::io::{Finished, HashedFile};
use calibrant::session::Source;
use std::path::Path;

/// A recording and what came of it.
pub(super) struct Recorded {
    /// What was told before an error ended the work. With a result, it is there.
    told: Vec<Diagnostic>,
    pub(super) outcome: calibrant::Result<Kept>,
}

/// The part of a result that is kept in memory.
pub(super) struct Kept {
    pub(super) finished: Finished,
    /// calibration.json, if it is to be printed.
    pub(super) json: String,
    /// Did an earlier run compute it?
    pub(super) earlier: bool,
}

impl Recorded {
    /// Calibrates from the recording and writes the results into this directory; or takes over those that are there, where the user asks for it.
    ///
    /// `files`: those of the recording; without them nothing is taken over.
    pub(super) fn of(job: &Job<'_>, source: &Source, files: Option<&[HashedFile]>, directory: &Path) -> Self {
        let kept_text = |text: String| if job.arguments.json { text } else { String::new() };
        let key = files.and_then(|files| job.key(files));
        let earlier = key.as_ref().filter(|_| job.arguments.resume);
        if let Some((finished, text)) = earlier.and_then(|key| Finished::read(directory, key)) {
            // the run that computed it need not have recorded it
            let recorded = job.records.add(|| text.clone());
            return Self {
                told: Vec::new(),
                outcome: recorded.map(|()| Kept { finished, json: kept_text(text), earlier: true }),
            };
        }
        let mut told = Vec::new();
        let outcome = job.run(source, directory, &mut told);
        let outcome = outcome.and_then(|outcome| {
            told.extend(outcome.warnings().iter().cloned());
            let finished = Finished {
                summary: outcome.summary(),
                cells: quality::cells(job.experiment, &outcome.calibrated),
                told: std::mem::take(&mut told),
            };
            if let Some(key) = &key {
                finished.write(directory, key, !job.arguments.no_report)?;
            }
            let text = if job.arguments.json { outcome.json() } else { String::new() };
            Ok(Kept { finished, json: text, earlier: false })
        });
        Self { told, outcome }
    }

    /// A recording that is not calibrated.
    pub(super) fn refused(error: Error) -> Self {
        Self { told: Vec::new(), outcome: Err(error) }
    }

    /// What is told of it.
    pub(super) fn told(&self) -> &[Diagnostic] {
        self.outcome.as_ref().map_or(&self.told, |kept| &kept.finished.told)
    }
}
