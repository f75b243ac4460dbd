//! Two steps after a validation: fold errors about the recording become a warning, and a validation on another recording gets its file name.

use calibrant_core::diagnostic::samples::CalibrationExtrapolated;
use calibrant_core::diagnostic::validation::FoldsImpossible;
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::{Error, Result};
use calibrant_core::estimate::{Validation, ValidationSource};
use calibrant_core::sensor::{ImuRecording, Temperatures, Thermal};
use calibrant_io::file_name;
use std::path::Path;

/// The cross-validation by folds. If the recording does not allow it (too few holds, for example), the calibration still stands: the reason becomes a warning and the result is `None`.
pub(crate) fn unless_too_few<T>(folds: Result<T>, notes: &mut Vec<Diagnostic>) -> Result<Option<T>> {
    match folds {
        Err(error @ Error::Recording(_)) => {
            notes.push(FoldsImpossible { why: Phrase(error.to_string()) }.into());
            Ok(None)
        }
        folds => folds.map(Some),
    }
}

/// What there is to say where the other recording is warmer or colder than the calibration reaches.
pub(crate) fn extrapolated(thermal: &Thermal, recording: &ImuRecording) -> Result<Option<Diagnostic>> {
    let range = Temperatures::of(recording)?.and_then(|temperatures| temperatures.range_c());
    Ok(range.and_then(|range| CalibrationExtrapolated::of(thermal, range)).map(Diagnostic::from))
}

/// Names the other recording that the validation is on.
pub(crate) fn on_recording(path: &Path, validation: Validation) -> Validation {
    Validation { source: ValidationSource::Recording { name: file_name(path) }, ..validation }
}
