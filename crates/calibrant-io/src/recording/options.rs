//! Options for reading a recording of an accelerometer.

use calibrant_core::sensor::ReadingUnit;

/// Options for reading a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadOptions {
    /// Unit of the readings where the user gives it (`--unit`); a header that contradicts it is an error.
    pub unit: Option<ReadingUnit>,
    /// Unit that the experiment expects. It applies where neither the header nor the user gives one.
    pub expected_unit: ReadingUnit,
    /// Number of axes that are needed, 1 or 3.
    pub axes: usize,
}
