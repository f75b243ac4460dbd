//! The files that a result came from.

use calibrant_core::number_format::{count, significant};
use calibrant_core::sensor::Recording;
use calibrant_recording::file_name;
use calibrant_recording::stated_rate::measured_rate_hz;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The recording from which a calibration came.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Input {
    /// Name of the file, without its directory, so that the result does not depend on the directory.
    pub file: String,
    /// SHA-256 of the file, hexadecimal. Of a piece of a ramp its times follow, after a colon.
    pub sha256: String,
    /// Number of samples read.
    pub samples: usize,
    /// Sample rate, Hz, with the digits that the times have.
    pub rate_hz: f64,
}

/// What stands between the SHA-256 of a file and the times of a part of it.
pub const PART: char = ':';

impl Input {
    /// SHA-256 of the whole file.
    #[must_use]
    pub fn of_file(&self) -> &str {
        self.sha256.split(PART).next().unwrap_or_default()
    }

    /// Samples and rate, in words.
    #[must_use]
    pub fn samples_in_words(&self) -> String {
        format!("{} at {} Hz", count(self.samples), significant(self.rate_hz, 5))
    }

    /// What was read of a file: `sha256` of its bytes, and the readings of its sensor.
    #[must_use]
    pub fn of(path: &Path, sha256: &str, readings: Option<&Recording>) -> Self {
        Self {
            file: file_name(path),
            sha256: sha256.to_owned(),
            samples: readings.map_or(0, Recording::len),
            rate_hz: readings.map_or(0.0, |of| measured_rate_hz(of.times_s())),
        }
    }
}
