//! Validations, whatever the sensor.

use super::note::Note;
use calibrant_core::error::{Error, Result};
use calibrant_core::estimate::{Validation, ValidationSource};
use calibrant_io::file_name;
use std::path::Path;

/// What folds say. A recording whose holds do not suffice for them is calibrated still.
pub(crate) fn unless_too_few(folds: Result<Validation>, notes: &mut Vec<Note>) -> Result<Option<Validation>> {
    match folds {
        Err(error @ Error::Recording(_)) => {
            notes.push(Note::Warning(format!("not validated by folds: {error}")));
            Ok(None)
        }
        folds => folds.map(Some),
    }
}

/// The validation on this recording.
pub(crate) fn on_recording(path: &Path, validation: Validation) -> Validation {
    Validation { source: ValidationSource::Recording { name: file_name(path) }, ..validation }
}
