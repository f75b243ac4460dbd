//! Refusals of a recording and a log that do not fit together.

use calibrant_core::error::{Error, InputError, Refusal};

pub(crate) fn refused(message: impl Into<String>, help: &str) -> Error {
    Error::recording(InputError::new(Refusal::MachineUnsolved, message, help))
}

/// The equations cannot be solved: a value is not finite, or nothing is determined.
pub(crate) fn unsolved() -> Error {
    refused(
        "the recording does not fit the log of the machine: the equations have no solution",
        "check that both are of the same motion, the units, the order of the joints, and the mounting",
    )
}
