//! A recording of one sensor is not that of another. A copy of it under another name has the same bytes.

use super::failure::Failure;
use crate::record::together;
use calibrant_core::error::{Error, InputError, Refusal};
use calibrant_io::HashedFile;
use rusqlite::{Connection, OptionalExtension};
use std::path::Path;

/// Refuses a recording that the records have as one of another sensor.
pub(super) fn refuse(
    connection: &Connection,
    path: &Path,
    sensor: &str,
    recordings: &[HashedFile],
) -> std::result::Result<(), Failure> {
    let query =
        "SELECT id, sensor FROM calibrations WHERE recording_sha256 = ? AND sensor <> ? ORDER BY id LIMIT 1";
    let other = connection
        .prepare_cached(query)?
        .query_row([&together(recordings), sensor], |row| Ok((row.get(0)?, row.get(1)?)))
        .optional()?;
    let Some((id, other)): Option<(i64, String)> = other else { return Ok(()) };
    let file = recordings.first().map_or("this recording", |file| file.file.as_str());
    let message = format!(
        "{} has {file} as calibration {id} of sensor {other:?}: is it of that sensor or of {sensor:?}?",
        path.display()
    );
    let help = format!(
        "record the sensor again, or, if {other:?} was wrong, remove calibration {id} with `calibrant records remove`"
    );
    let error = InputError::new(Refusal::RecordingRepeated, message, help);
    Err(Failure::Refused(Error::recording(error)))
}
