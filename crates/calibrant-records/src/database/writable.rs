//! Can the records be written? This is found out before the work whose results they are to keep.

use super::failure::failed;
use super::schema::VERSION;
use calibrant_core::error::{Error, Result};
use rusqlite::{Connection, ErrorCode, TransactionBehavior};
use std::io;
use std::path::Path;

/// Refuses a database that cannot be written: it is read-only, or no journal can stand beside it.
pub(crate) fn check_writable(connection: &mut Connection, path: &Path) -> Result<()> {
    let refused = |kind, message: &str| Error::Output {
        path: path.to_path_buf(),
        source: io::Error::new(kind, message),
    };
    if connection.is_readonly("main").map_err(|error| failed(path, error))? {
        return Err(refused(io::ErrorKind::PermissionDenied, "the file is read-only"));
    }
    let behaviour = TransactionBehavior::Immediate;
    let tried = connection.transaction_with_behavior(behaviour).and_then(|transaction| {
        // the first change makes the journal; it is taken back
        transaction.pragma_update(None, "user_version", VERSION)?;
        transaction.rollback()
    });
    tried.map_err(|error| match error.sqlite_error_code() {
        Some(ErrorCode::CannotOpen) => refused(io::ErrorKind::Other, "no journal can be made beside it"),
        _ => failed(path, error),
    })
}
