//! What the caller of a pipeline chooses, for all recordings.

use super::source::Source;
use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::diagnostic::Code;
use calibrant_io::{ImuReadOptions, SensorNaming};
use std::path::PathBuf;

/// What is said of all recordings of a pipeline beside the experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct PipelineOptions {
    /// The experiment file, as the report and errors name it.
    pub experiment_file: PathBuf,
    /// The commanded motion; a `[motion]` experiment needs one.
    pub motion: Option<PathBuf>,
    /// What the recordings' files do not say themselves. It counts before `[columns]` of the experiment.
    pub reading: ImuReadOptions,
    /// Another recording of the sensor, on which the calibration is tried.
    pub validate: Option<Source>,
    /// The log of the machine's motion in that recording; on a machine it needs one, or has it in its own file.
    pub validate_motion: Option<PathBuf>,
    /// Number of blocks of holds (on a machine: of time), each predicted by a calibration from the others.
    pub folds: Option<usize>,
    /// The limits that a result must keep; `None`: those of the experiment.
    pub accept: Option<Vec<AcceptanceLimit>>,
    /// Diagnostics that the files mark as allowed. They do not count for the verdict.
    pub allowed: Vec<Code>,
    /// Which sensor a recording is of, and where it was made.
    pub naming: SensorNaming,
    /// Is `report.html` written?
    pub report: bool,
}

impl Default for PipelineOptions {
    fn default() -> Self {
        Self {
            experiment_file: PathBuf::new(),
            motion: None,
            reading: ImuReadOptions::default(),
            validate: None,
            validate_motion: None,
            folds: None,
            accept: None,
            allowed: Vec::new(),
            naming: SensorNaming::default(),
            report: true,
        }
    }
}
