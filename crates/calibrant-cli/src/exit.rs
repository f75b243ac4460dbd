//! The exit status of a command.

use calibrant::Error;

/// The exit status with which a command ended.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Exit(pub(crate) u8);

impl Exit {
    /// The command did its work.
    pub(crate) const DONE: Exit = Exit(0);
    /// Done, but a denied diagnostic occurred.
    pub(crate) const DENIED: Exit = Exit(1);
    /// Bad usage or experiment file, or a result that cannot be written.
    pub(crate) const USAGE: Exit = Exit(2);
    /// The recording is bad.
    pub(crate) const RECORDING: Exit = Exit(3);
    /// The data or the motion do not determine the parameters, or the limits admit no motion, or not the one that is evaluated.
    pub(crate) const NOT_IDENTIFIABLE: Exit = Exit(4);
    /// A result is written, and it is bad, or breaks a limit.
    pub(crate) const BAD: Exit = Exit(5);

    /// Interrupted, as a shell says it. Results of `design`, `study` and a batch are those so far.
    pub(crate) const INTERRUPTED: Exit = Exit(130);

    /// The exit status of an error.
    pub(crate) fn of(error: &Error) -> Exit {
        if error.is_not_identifiable() || error.is_infeasible() {
            Exit::NOT_IDENTIFIABLE
        } else if error.is_invalid_recording() {
            Exit::RECORDING
        } else {
            Exit::USAGE
        }
    }
}
