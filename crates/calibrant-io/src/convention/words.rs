//! Words that all formats share.

use calibrant_core::error::{InputError, Refusal};

/// Program and version, for the first line of a file.
pub(super) fn written_by() -> String {
    format!("written by calibrant {}", env!("CARGO_PKG_VERSION"))
}

/// An input error without a place.
pub(super) fn input_error(code: Refusal, message: impl Into<String>, help: &str) -> Box<InputError> {
    Box::new(InputError::new(code, message, help))
}

/// The error for a file that is no calibration, or contradicts itself.
pub(super) fn invalid(message: impl Into<String>, help: &str) -> Box<InputError> {
    input_error(Refusal::CalibrationInvalid, message, help)
}
