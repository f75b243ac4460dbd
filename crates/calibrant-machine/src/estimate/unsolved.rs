//! The refusal where the equations have no solution.

use calibrant_core::error::{Error, InputError, Refusal};

/// The equations cannot be solved: a value is not finite, or nothing is determined.
pub(super) fn unsolved() -> Error {
    Error::recording(InputError::new(
        Refusal::MachineUnsolved,
        "the recording does not fit the log of the machine: the equations have no solution",
        "check that both are of the same motion, the units, the order of the joints, and the mounting",
    ))
}
