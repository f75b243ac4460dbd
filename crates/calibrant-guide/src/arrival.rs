//! What comes from an input, block by block.

/// What comes from an input. Times are in s after the begin.
#[derive(Debug)]
pub(crate) enum Arrival {
    /// Bytes.
    Bytes { bytes: Vec<u8>, at_s: f64 },
    /// The input is gone; it is tried again.
    Lost(String),
    /// The input is there again.
    Back,
    /// There is no more.
    End,
}
