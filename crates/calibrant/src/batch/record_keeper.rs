//! The records to which the results of a batch are added.

use calibrant_core::error::Result;
use calibrant_io::HashedFile;
#[cfg(feature = "records")]
use calibrant_records::{Record, Records};
use std::path::Path;
#[cfg(feature = "records")]
use std::sync::{Mutex, PoisonError};

/// Adds each result to a database, where the options name one.
pub(super) struct RecordKeeper {
    #[cfg(feature = "records")]
    records: Option<Mutex<Records>>,
}

#[cfg(feature = "records")]
impl RecordKeeper {
    /// Opens the database, before the work begins.
    pub(super) fn open(file: Option<&Path>) -> Result<Self> {
        Ok(Self { records: file.map(Records::open).transpose()?.map(Mutex::new) })
    }

    /// Refuses a recording that the records have as one of another sensor, before it is calibrated. `sensor` and `files` are asked only where there are records; without one of
    /// them nothing is refused.
    pub(super) fn check(
        &self,
        sensor: impl FnOnce() -> Option<String>,
        files: impl FnOnce() -> Option<Vec<HashedFile>>,
    ) -> Result<()> {
        let Some(records) = &self.records else { return Ok(()) };
        let (Some(sensor), Some(files)) = (sensor(), files()) else { return Ok(()) };
        records.lock().unwrap_or_else(PoisonError::into_inner).refuse_repeated(&sensor, &files)
    }

    /// Adds a result, by the text of its calibration.json.
    pub(super) fn add(&self, text: impl FnOnce() -> String) -> Result<()> {
        let Some(records) = &self.records else { return Ok(()) };
        let record = Record::parse(&text())?;
        records.lock().unwrap_or_else(PoisonError::into_inner).insert(&record)?;
        Ok(())
    }
}

#[cfg(not(feature = "records"))]
impl RecordKeeper {
    pub(super) fn open(file: Option<&Path>) -> Result<Self> {
        use calibrant_core::error::{Error, InputError, Refusal, TaskOption};
        match file {
            None => Ok(Self {}),
            Some(path) => {
                let option = TaskOption::Records;
                let help =
                    format!("leave {option} away. For records, {}", calibrant_io::install_with("records"));
                let error = InputError::new(Refusal::FormatUnsupported, "this build keeps no records", help);
                Err(Error::experiment(error.in_file(path)))
            }
        }
    }

    pub(super) fn check(
        &self,
        _: impl FnOnce() -> Option<String>,
        _: impl FnOnce() -> Option<Vec<HashedFile>>,
    ) -> Result<()> {
        Ok(())
    }

    pub(super) fn add(&self, _: impl FnOnce() -> String) -> Result<()> {
        Ok(())
    }
}
