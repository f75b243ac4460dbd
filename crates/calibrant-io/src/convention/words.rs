//! Words that all formats share.

use calibrant_core::error::InputError;

/// Program and version, for the first line of a file.
pub(super) fn written_by() -> String {
    format!("written by calibrant {}", env!("CARGO_PKG_VERSION"))
}

/// An input error without a place.
pub(super) fn input_error(message: impl Into<String>, help: &str) -> Box<InputError> {
    Box::new(InputError::new(message, help))
}
