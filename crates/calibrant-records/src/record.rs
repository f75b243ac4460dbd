//! A record: what is kept of a `calibration.json`.

use calibrant_core::diagnostic::Usability;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{CalibratedImu, ImuParameters};
use calibrant_io::{Checked, HashedFile, UtcTime, parse_estimates, read_text};
use schemars::JsonSchema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A calibration with where it comes from. Its JSON has no parameters: those stand in [`RecordFile`](crate::RecordFile).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Record {
    /// The sensor.
    pub sensor: String,
    /// When the recording was made, UTC, where that is known.
    pub recorded: Option<UtcTime>,
    /// Where it was made.
    pub station: Option<String>,
    /// What the sensor was compared with: `motion`, `holds` or `machine`.
    #[serde(default)]
    pub plan: String,
    /// The experiment file.
    pub experiment: Option<HashedFile>,
    /// The commanded motion, or the log of a machine, where it is a file of its own.
    pub motion_file: Option<HashedFile>,
    /// The files of the recording; there is at least one.
    #[serde(alias = "inputs")]
    pub recordings: Vec<HashedFile>,
    /// May it be used?
    pub verdict: KeptVerdict,
    /// How the estimation ended: `converged`, ….
    pub status: String,
    /// The program that calibrated, with its version.
    pub program: String,
    /// The parameters with their covariance.
    #[serde(skip, default = "no_parameters")]
    pub imu: CalibratedImu,
}

/// May a calibration be used, and which diagnostics decide it?
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct KeptVerdict {
    /// May it be used?
    pub usability: Usability,
    /// Codes of the diagnostics that decide. They may be those of another version.
    pub codes: Vec<String>,
}

/// The sections of a calibration that say what the sensor was compared with.
#[derive(Deserialize)]
struct Sections {
    motion: Option<IgnoredAny>,
    machine: Option<IgnoredAny>,
}

impl Record {
    /// Reads a `calibration.json` that `calibrant calibrate` wrote; also one that did not converge.
    ///
    /// # Errors
    /// [`Error::Experiment`] where it cannot be read, or does not say its sensor, its verdict and its recording.
    pub fn read(path: &Path) -> Result<Self> {
        /// The largest file that is read, bytes.
        const LIMIT: u64 = 1 << 28;
        let text = read_text(path, LIMIT, "a calibration").map_err(Error::Experiment)?;
        Self::checked(&text).map_err(|error| Error::experiment(error.in_file(path)))
    }

    /// The record of the text of a `calibration.json`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str) -> Result<Self> {
        Self::checked(text).map_err(Error::Experiment)
    }

    fn checked(text: &str) -> Checked<Self> {
        let imu = parse_estimates(text)?;
        let broken = |error: serde_json::Error| untraceable(error.to_string());
        let mut record: Self = serde_json::from_str(text).map_err(broken)?;
        if record.recordings.is_empty() {
            return Err(untraceable("`inputs` is empty".to_owned()));
        }
        if record.plan.is_empty() {
            let plan = match serde_json::from_str(text).map_err(broken)? {
                Sections { machine: Some(_), .. } => "machine",
                Sections { motion: Some(_), .. } => "motion",
                Sections { .. } => "holds",
            };
            record.plan = plan.to_owned();
        }
        Ok(Self { imu, ..record })
    }

    /// The hashes of its recordings, with blanks between them: what tells it from other recordings.
    #[must_use]
    pub fn recording_sha256(&self) -> String {
        together(&self.recordings)
    }

    /// The names of its recordings, with commas between them.
    #[must_use]
    pub fn recording(&self) -> String {
        self.names().join(", ")
    }

    /// The names of its recordings. None has a slash in it.
    pub(crate) fn names(&self) -> Vec<&str> {
        self.recordings.iter().map(|file| file.file.as_str()).collect()
    }
}

/// What a record has while only its JSON is read.
fn no_parameters() -> CalibratedImu {
    CalibratedImu::new(ImuParameters::identity(), [None, None], Vec::new(), "")
}

/// The hashes of the files of a recording, with blanks between them.
pub(crate) fn together(recordings: &[HashedFile]) -> String {
    recordings.iter().map(|file| file.sha256.as_str()).collect::<Vec<_>>().join(" ")
}

fn untraceable(message: String) -> Box<InputError> {
    let help = "give a calibration.json that `calibrant calibrate` of this version wrote";
    InputError::new(Refusal::CalibrationInvalid, message, help).into()
}
