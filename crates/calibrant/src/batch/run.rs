//! The batch and its work.

use super::checks::check;
use super::copies::Copies;
use super::folders::folder_names;
use super::options::BatchOptions;
use super::parallel::in_parallel;
use super::quality::cells;
use super::record_keeper::RecordKeeper;
use super::result::{BatchResult, BatchResults, BatchRow, RESULT_FILES};
use crate::session::{Outcome, Session, Source};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, Refusal, Result};
use calibrant_core::progress::Progress;
use calibrant_io::{Finished, HashedFile, ResumeKey, write_text};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

/// Recordings of one experiment.
pub struct Batch {
    session: Session,
    sources: Vec<Source>,
    options: BatchOptions,
    records: RecordKeeper,
}

impl Batch {
    /// Checks the recordings, and opens the records.
    ///
    /// # Errors
    /// [`Error::Experiment`](crate::Error::Experiment) where an option is for a single recording, where a recording is the commanded motion, where records would
    /// take several sensors for one, or where the records cannot be opened.
    pub fn new(session: Session, sources: Vec<Source>, options: BatchOptions) -> Result<Self> {
        check(&session, &sources, options.records.is_some())?;
        let records = RecordKeeper::open(options.records.as_deref())?;
        Ok(Self { session, sources, options, records })
    }

    /// What the recordings share.
    #[must_use]
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The recordings.
    #[must_use]
    pub fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// Calibrates from one of the recordings by itself, writes its results into the directory and adds them to the records. What is noticed goes to `notes`, even if it fails.
    ///
    /// # Errors
    /// As [`Session::calibrate_noting`]; where the records have the recording as one of another sensor; where a file cannot be written.
    pub fn calibrate(&self, source: &Source, notes: &mut Vec<Diagnostic>) -> Result<Outcome> {
        self.check_records(source, || source.hashed())?;
        Ok(self.calibrate_into(self.options.directory.as_deref(), source, None, notes)?.0)
    }

    /// Calibrates from all recordings, several at the same time: as many as there are threads. The progress counts recordings. After an interruption of the
    /// session, the recordings that were not begun have the error that it gives.
    #[must_use]
    pub fn run(&self, progress: &Progress) -> BatchResults {
        let count = self.sources.len();
        let folders = folder_names(&self.sources.iter().map(Source::path).collect::<Vec<_>>());
        let files = in_parallel(count, |number| self.sources[number].hashed());
        let copies = Copies::among(&files);
        let shared = self.session.key();
        let done = AtomicU64::new(0);
        let row = |number: usize| {
            let (source, files, folder) = (&self.sources[number], &files[number], &folders[number]);
            let key = shared.as_ref().zip(files.as_ref()).map(|(shared, files)| shared.with(files));
            let mut told = Vec::new();
            let path_of = |(number, k): (usize, usize)| self.sources[number].files().nth(k);
            let refused = copies.refusal(number, path_of).map_or(Ok(()), Err);
            let outcome = refused
                .and_then(|()| self.session.options().interruption.check())
                .and_then(|()| self.check_records(source, || files.clone()))
                .and_then(|()| self.result(source, folder, key.as_ref(), &mut told));
            let has_failure_page =
                outcome.as_ref().is_err_and(|error| self.write_failure(source, folder, error));
            progress.tell("recordings", done.fetch_add(1, Ordering::Relaxed) + 1, count as u64);
            let (folder, recording) = (folder.clone(), source.path().to_path_buf());
            BatchRow { folder, recording, files: files.clone(), key, outcome, has_failure_page, told }
        };
        BatchResults { rows: in_parallel(count, row), copies: copies.groups() }
    }

    /// The same of other recordings, without records.
    pub(crate) fn with_sources(&self, sources: Vec<Source>) -> Result<Self> {
        let session = Session::with(self.session.experiment().clone(), self.session.options().clone())?;
        Self::new(session, sources, BatchOptions { records: None, ..self.options.clone() })
    }

    /// Removes what this run wrote of a recording: another result takes its place.
    pub(crate) fn forget(&self, row: &BatchRow) {
        if let Some(directory) = &self.options.directory {
            let directory = directory.join(&row.folder);
            // what is not there need not go
            RESULT_FILES.iter().for_each(|name| drop(std::fs::remove_file(directory.join(name))));
            let mut left = std::fs::read_dir(&directory).into_iter().flatten().flatten();
            // the list of what was written there
            if left.all(|file| file.file_name().to_string_lossy().starts_with(".calibrant")) {
                drop(std::fs::remove_dir_all(directory));
            }
        }
    }

    /// Calibrates from one of the recordings once more, by another session of the same kind. `row` is what came of it before.
    pub(crate) fn again(&self, number: usize, row: &BatchRow, session: Session) -> Result<BatchRow> {
        let (sources, records) = (vec![self.sources[number].clone()], RecordKeeper::open(None)?);
        let options = BatchOptions { resume: false, records: None, ..self.options.clone() };
        let other = Self { session, sources, options, records };
        let mut told = Vec::new();
        let outcome = other.result(&other.sources[0], &row.folder, row.key.as_ref(), &mut told);
        let has_failure_page =
            outcome.as_ref().is_err_and(|error| other.write_failure(&other.sources[0], &row.folder, error));
        let (folder, recording) = (row.folder.clone(), row.recording.clone());
        let (files, key) = (row.files.clone(), row.key.clone());
        Ok(BatchRow { folder, recording, files, key, outcome, has_failure_page, told })
    }

    /// Calibrates from a recording into its folder, or takes over what is there, where the options ask for it. Without a `key` nothing is taken over.
    fn result(
        &self,
        source: &Source,
        folder: &str,
        key: Option<&ResumeKey>,
        told: &mut Vec<Diagnostic>,
    ) -> Result<BatchResult> {
        let directory = self.options.directory.as_ref().map(|directory| directory.join(folder));
        let kept = directory.as_deref().zip(key);
        let earlier = kept.filter(|_| self.options.resume);
        let keep = |text: String| if self.options.keep_json { text } else { String::new() };
        // they are of this run, not of the result
        let mut notes = Vec::new();
        let earlier = earlier.and_then(|(directory, key)| Finished::read(directory, key, &mut notes));
        if let Some((finished, text)) = earlier {
            // the run that computed it need not have recorded it
            self.records.add(|| text.clone())?;
            return Ok(BatchResult { finished, json: keep(text), earlier: true });
        }
        let (outcome, json) = self.calibrate_into(directory.as_deref(), source, Some(folder), told)?;
        told.extend(outcome.warnings().iter().cloned());
        let mut finished = Finished {
            summary: outcome.summary(),
            cells: cells(self.session.experiment(), &outcome.calibrated),
            told: std::mem::take(told),
            sensor: outcome.origin.sensor.clone(),
            station: outcome.origin.station.clone(),
            recorded: outcome.origin.recorded.map(|time| time.to_string()),
        };
        if let Some((directory, key)) = kept {
            finished.write(directory, key, self.session.options().report)?;
        }
        finished.told.append(&mut notes);
        Ok(BatchResult { finished, json: json.unwrap_or_default(), earlier: false })
    }

    /// The outcome, and the text of its `calibration.json` where the options keep it. `name`: that of the sensor among the others, where nobody names the sensors.
    fn calibrate_into(
        &self,
        directory: Option<&Path>,
        source: &Source,
        name: Option<&str>,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<(Outcome, Option<String>)> {
        let mut outcome = self.session.calibrate_noting(source, notes)?;
        if let Some(name) = name.filter(|_| !self.session.options().naming.names_sensors()) {
            outcome.origin.sensor = Some(name.replace(char::is_control, "_"));
        }
        let json = self.options.keep_json.then(|| outcome.json());
        directory.map_or(Ok(()), |directory| outcome.write_with(directory, json.as_deref()))?;
        self.records.add(|| json.clone().unwrap_or_else(|| outcome.json()))?;
        Ok((outcome, json))
    }

    /// Writes the page about a recording that could not be calibrated, where there is something to show. Is there one?
    fn write_failure(&self, source: &Source, folder: &str, error: &Error) -> bool {
        let options = self.session.options();
        let Some(directory) = self.options.directory.as_ref().filter(|_| options.report) else {
            return false;
        };
        if error.code() == Refusal::Interrupted {
            return false;
        }
        let page = self.session.failure_html(source, error);
        page.is_some_and(|page| write_text(&directory.join(folder).join("report.html"), &page).is_ok())
    }

    /// Refuses a recording that the records have as one of another sensor. `files`: its own by their content; `None` where one cannot be read.
    fn check_records(&self, source: &Source, files: impl FnOnce() -> Option<Vec<HashedFile>>) -> Result<()> {
        // a name that is not of the pattern is refused where the recording is calibrated
        let sensor = || Some(self.session.options().naming.of(source.path()).ok()?.sensor);
        self.records.check(sensor, files).map_err(|error| error.in_recording(source.path()))
    }
}
