//! What a log has, whatever its format.

use super::stream::Stream;

/// What a log has of IMUs.
pub(crate) struct AutopilotLog {
    /// The readings of each sensor, in the order in which the log begins them.
    pub(crate) streams: Vec<Stream>,
    /// Version of the program that wrote it, where it says so: major and minor number.
    pub(crate) version: Option<(u8, u8)>,
    pub(crate) passed_over: PassedOver,
}

/// Bytes that are no messages.
#[derive(Default)]
pub(crate) struct PassedOver {
    pub(crate) bytes: usize,
    /// Number of places where there are some.
    pub(crate) places: usize,
}

impl PassedOver {
    pub(super) fn add(&mut self, bytes: usize) {
        self.bytes += bytes;
        self.places += 1;
    }
}
