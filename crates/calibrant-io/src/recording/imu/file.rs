//! The data types of an IMU's recording as a file holds it.

use super::column::ImuColumn;
use super::format::FileFormat;
use crate::recording::reader_finding::Finding;
use calibrant_core::sensor::ImuRecording;

/// A recording of an IMU as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ImuFile {
    /// The samples: times in s, strictly increasing, everything finite; SI or counts.
    pub recording: ImuRecording,
    /// The format, as recognised or given; of a pair the accelerometer's.
    pub format: FileFormat,
    /// The columns in their order, used or not; of both files for a pair.
    pub columns: Vec<ImuColumn>,
    /// What was noticed and repaired.
    pub findings: Vec<Finding>,
    /// Number of rows, dropped ones included; of a pair the accelerometer's.
    pub rows: usize,
    /// SHA-256 of the bytes of each file, hexadecimal.
    pub sha256: Vec<String>,
    /// The gyroscope's file of a pair.
    pub second: Option<SecondFile>,
    /// The time from which the times count, ns, where they count from their first and the file has another.
    pub counted_from_ns: Option<i128>,
}

/// The facts about the gyroscope's file of a pair.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SecondFile {
    /// The format, as recognised or given.
    pub format: FileFormat,
    /// Number of rows, dropped ones included.
    pub rows: usize,
    /// Number of its columns: the last ones of [`ImuFile::columns`].
    pub columns: usize,
}
