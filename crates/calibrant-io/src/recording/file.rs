//! The data type of an accelerometer's recording as a file holds it.

use super::reader_finding::Finding;
use calibrant_core::sensor::Recording;

/// A recording as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingFile {
    /// The samples: times strictly increasing, everything finite. Its unit is the file's. Where it differs
    /// from the expected one, there is a finding.
    pub recording: Recording,
    /// What was noticed and repaired.
    pub findings: Vec<Finding>,
    /// SHA-256 of the file's bytes, hexadecimal.
    pub sha256: String,
    /// Number of lines of the file.
    pub lines: usize,
}
