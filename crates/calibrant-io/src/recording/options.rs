//! How a recording of an accelerometer is read.

use calibrant_core::sensor::ReadingUnit;

/// How a recording is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadOptions {
    /// Unit of the readings where the user gives it (`--unit`); a header that contradicts it is an error.
    pub unit: Option<ReadingUnit>,
    /// Unit that the experiment expects: that of the readings where neither the header nor the user says.
    pub expected_unit: ReadingUnit,
    /// Number of axes that are needed, 1 or 3.
    pub axes: usize,
}
