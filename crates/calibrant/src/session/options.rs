//! What the caller of a session chooses, for all recordings.

use super::motion_source::MotionSource;
use super::source::Source;
use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::diagnostic::Code;
use calibrant_core::interruption::Interruption;
use calibrant_core::progress::Progress;
use calibrant_io::{ImuReadOptions, SensorNaming};
use calibrant_machine::estimate::MachineSettings;
use std::path::PathBuf;

/// What is said of all recordings of a session beside the experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionOptions {
    /// The experiment file, as the report and errors name it.
    pub experiment_file: PathBuf,
    /// The commanded motion, which a `[motion]` experiment needs, or the log of a machine's motion.
    pub motion: Option<MotionSource>,
    /// What the recordings' files do not say themselves. It counts before `[columns]` of the experiment.
    pub reading: ImuReadOptions,
    /// Another recording of the sensor, on which the calibration is tried.
    pub validate: Option<Source>,
    /// The log of the machine's motion in that recording; on a machine it needs one, or has it in its own file.
    pub validate_motion: Option<MotionSource>,
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
    /// Ends a calibration on a machine without a result.
    pub interruption: Interruption,
    /// Is told how far a calibration on a machine is.
    pub progress: Progress,
}

impl SessionOptions {
    /// In words, but for what the work may take and who waits for it, and for where experiment and motion are: results depend on their content.
    pub(crate) fn in_words(&self) -> String {
        let knot_step_s = match &self.motion {
            Some(MotionSource::OnKnots(_, knot_step_s)) => Some(*knot_step_s),
            _ => None,
        };
        let (interruption, progress) = (Interruption::default(), Progress::default());
        let mut options =
            Self { experiment_file: PathBuf::new(), motion: None, interruption, progress, ..self.clone() };
        options.reading.budget = None;
        format!("{options:?}, knots {knot_step_s:?}")
    }

    /// How a calibration on a machine is solved.
    pub(crate) fn machine_settings(&self) -> MachineSettings {
        let (interruption, progress) = (self.interruption.clone(), self.progress.clone());
        MachineSettings { interruption, progress, ..MachineSettings::default() }
    }
}

impl Default for SessionOptions {
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
            interruption: Interruption::default(),
            progress: Progress::default(),
        }
    }
}
