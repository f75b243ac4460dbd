//! Errors about keys of an experiment. Where it is read from a text, their places are added later.

use super::number::{Bounds, Within};
use calibrant_core::error::{Error, InputError, Refusal, Result};

/// A key whose value makes no sense beside the others; empty for the whole.
pub(super) fn refused(key: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Error {
    let (key, input_error) = (key.into(), InputError::new(Refusal::ValueInvalid, message, help));
    Error::experiment(if key.is_empty() { input_error } else { input_error.about_key(key) })
}

/// A key that is needed beside the others.
pub(super) fn missing(key: impl Into<String>, help: impl Into<String>) -> Error {
    let message = "this required key is missing";
    Error::experiment(InputError::new(Refusal::KeyMissing, message, help).about_key(key))
}

/// The number, where it lies within narrower bounds than those of its type.
pub(super) fn narrowed<R: Copy>(key: impl Into<String>, number: Within<R>, bounds: &Bounds) -> Result<f64> {
    match bounds.complaint(number.get()) {
        None => Ok(number.get()),
        Some(complaint) => Err(refused(key, complaint, bounds.to_string())),
    }
}
