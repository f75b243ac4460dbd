//! The logs of autopilots: PX4's ULog and ArduPilot's DataFlash.
//!
//! Both say in themselves which fields their messages have. [`layout`] finds the fields, [`stream`] collects the readings of each sensor, and
//! [`ulog`] and [`dataflash`] split the bytes into messages.

pub(crate) mod dataflash;
mod layout;
pub(crate) mod stream;
pub(crate) mod ulog;

use stream::Stream;

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
    fn add(&mut self, bytes: usize) {
        self.bytes += bytes;
        self.places += 1;
    }
}
