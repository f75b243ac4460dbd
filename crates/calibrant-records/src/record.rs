//! A record: what is kept of a `calibration.json`.

use calibrant_core::diagnostic::Usability;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::CalibratedImu;
use calibrant_io::{Checked, HashedFile, Input, UtcTime, parse_estimates, read_text};
use serde::Deserialize;
use std::path::Path;

/// A calibration with where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// The sensor.
    pub sensor: String,
    /// When the recording was made, where that is known.
    pub recorded: Option<UtcTime>,
    /// Where it was made.
    pub station: Option<String>,
    /// The program that calibrated, with its version.
    pub program: String,
    /// What the sensor was compared with: `motion`, `holds` or `machine`.
    pub plan: String,
    /// The experiment file.
    pub experiment: Option<HashedFile>,
    /// The commanded motion, or the log of a machine, where it is a file of its own.
    pub motion_file: Option<HashedFile>,
    /// The files of the recording; there is at least one.
    pub recordings: Vec<HashedFile>,
    /// May it be used?
    pub verdict: Usability,
    /// Codes of the diagnostics that decide the verdict.
    pub codes: Vec<String>,
    /// How the estimation ended: `converged`, ….
    pub status: String,
    /// The parameters with their covariance.
    pub imu: CalibratedImu,
}

#[derive(Deserialize)]
struct Fields {
    program: Option<String>,
    sensor: Option<String>,
    recorded: Option<String>,
    station: Option<String>,
    experiment: Option<HashedFile>,
    motion_file: Option<HashedFile>,
    verdict: Option<VerdictFields>,
    status: Option<String>,
    #[serde(default)]
    inputs: Vec<Input>,
    motion: Option<serde::de::IgnoredAny>,
    machine: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
struct VerdictFields {
    usability: String,
    #[serde(default)]
    codes: Vec<String>,
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
        let fields: Fields = serde_json::from_str(text).map_err(|error| untraceable(error.to_string()))?;
        let missing = |what: &str| untraceable(format!("`{what}` is missing"));
        let verdict = fields.verdict.ok_or_else(|| missing("verdict"))?;
        let plan = match (fields.machine, fields.motion) {
            (Some(_), _) => "machine",
            (None, Some(_)) => "motion",
            (None, None) => "holds",
        };
        if fields.inputs.is_empty() {
            return Err(missing("inputs"));
        }
        let recorded = fields.recorded.map(|text| {
            UtcTime::parse(&text)
                .ok_or_else(|| untraceable(format!("`recorded` is {text:?}, which is no date")))
        });
        Ok(Self {
            sensor: fields.sensor.ok_or_else(|| missing("sensor"))?,
            recorded: recorded.transpose()?,
            station: fields.station,
            program: fields.program.ok_or_else(|| missing("program"))?,
            plan: plan.to_owned(),
            experiment: fields.experiment,
            motion_file: fields.motion_file,
            recordings: (fields.inputs.into_iter())
                .map(|Input { file, sha256, .. }| HashedFile { file, sha256 })
                .collect(),
            verdict: Usability::parse(&verdict.usability)
                .ok_or_else(|| untraceable(format!("the verdict is {:?}", verdict.usability)))?,
            codes: verdict.codes,
            status: fields.status.ok_or_else(|| missing("status"))?,
            imu,
        })
    }

    /// The hashes of its recordings, with blanks between them: what tells it from other recordings.
    #[must_use]
    pub fn recording_sha256(&self) -> String {
        together(&self.recordings)
    }

    /// The names of its recordings, with commas between them.
    #[must_use]
    pub fn recording(&self) -> String {
        self.recordings.iter().map(|file| file.file.as_str()).collect::<Vec<_>>().join(", ")
    }
}

/// The hashes of the files of a recording, with blanks between them.
pub(crate) fn together(recordings: &[HashedFile]) -> String {
    recordings.iter().map(|file| file.sha256.as_str()).collect::<Vec<_>>().join(" ")
}

fn untraceable(message: String) -> Box<InputError> {
    let help = "give a calibration.json that `calibrant calibrate` of this version wrote";
    InputError::new(Refusal::CalibrationInvalid, message, help).into()
}
