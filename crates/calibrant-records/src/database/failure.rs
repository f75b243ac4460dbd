//! Failures of SQLite in our words.

use calibrant_core::error::{Error, InputError, Refusal};
use rusqlite::ErrorCode;
use std::io;
use std::path::Path;

/// Why a transaction is taken back.
pub(super) enum Failure {
    /// SQLite cannot do it.
    Sqlite(rusqlite::Error),
    /// The records refuse it.
    Refused(Error),
}

impl Failure {
    /// The error of these records.
    pub(super) fn of(self, path: &Path) -> Error {
        match self {
            Self::Sqlite(error) => failed(path, error),
            Self::Refused(error) => error,
        }
    }
}

impl From<rusqlite::Error> for Failure {
    fn from(error: rusqlite::Error) -> Self {
        Self::Sqlite(error)
    }
}

/// The error for a failure of SQLite with this database.
pub(super) fn failed(path: &Path, error: rusqlite::Error) -> Error {
    let input = |refusal, message: &str, help: &str| {
        Error::experiment(InputError::new(refusal, message, help).in_file(path))
    };
    match error.sqlite_error_code() {
        Some(ErrorCode::NotADatabase) => not_a_database(path),
        Some(ErrorCode::DatabaseCorrupt) => damaged(path, &error.to_string()),
        Some(ErrorCode::CannotOpen) => input(
            Refusal::FileUnreadable,
            "cannot open the records",
            "check the name, and who may read and write it",
        ),
        Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => {
            let message = "another program has been writing these records for a minute";
            Error::Output {
                path: path.to_path_buf(),
                source: io::Error::new(io::ErrorKind::WouldBlock, message),
            }
        }
        Some(_) => Error::Output { path: path.to_path_buf(), source: io::Error::other(error.to_string()) },
        // a value of another type than the schema has
        None => damaged(path, &error.to_string()),
    }
}

/// The error for a file that is no database.
pub(super) fn not_a_database(path: &Path) -> Error {
    let message = "this file is there already, and is no database of records";
    Error::experiment(
        InputError::new(Refusal::FormatUnknown, message, "give another file for the records").in_file(path),
    )
}

/// The error for a file without contents, where records should be.
pub(super) fn empty(path: &Path) -> Error {
    let help =
        "give another file, or remove this one: `calibrate --records` and `calibrant records add` make it";
    Error::experiment(
        InputError::new(Refusal::FormatUnknown, "this file is empty: there are no records in it", help)
            .in_file(path),
    )
}

/// The error for a calibration that is not there.
pub(super) fn unknown(path: &Path, id: i64) -> Error {
    let help = "`calibrant records list` shows the numbers";
    let message = format!("there is no calibration {id}");
    Error::experiment(InputError::new(Refusal::ValueInvalid, message, help).in_file(path))
}

/// The error for records that cannot be as they are.
pub(super) fn damaged(path: &Path, what: &str) -> Error {
    let help = "restore a copy, or make new records of the files with `calibrant records add`";
    let message = format!("the records are damaged: {what}");
    Error::experiment(InputError::new(Refusal::FileDamaged, message, help).in_file(path))
}
