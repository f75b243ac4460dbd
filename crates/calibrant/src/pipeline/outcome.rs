//! What comes of a recording, and the files that it is written to.

use super::note::Note;
use calibrant_core::diagnostic::{Code, Diagnostic};
use calibrant_core::error::Result;
use calibrant_core::estimate::{Calibration, CalibrationStatus, Validation};
use calibrant_core::noise::SensorNoise;
use calibrant_core::sensor::ImuRecording;
use calibrant_io::{DiagnosticWords, Input, Summary, calibration_json, write_atomically, write_calibration};
use calibrant_report::{About, calibration_report, message};
use std::path::Path;

/// A calibration with everything that stands beside it.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The calibration.
    pub calibration: Calibration,
    /// How it fares on data that it is not from, where the options ask for it.
    pub validations: Vec<Validation>,
    /// The noise of an IMU in its longest hold, in m/s² and rad/s, as the report shows it. Empty without a report.
    pub noise: Vec<SensorNoise>,
    /// What was noticed, in the order in which people should read it. Warnings of the calibration are in itself.
    pub notes: Vec<Note>,
    /// The files that were read.
    pub inputs: Vec<Input>,
    /// The recording without outliers.
    pub(crate) recording: ImuRecording,
    /// Diagnostics that the files mark as allowed.
    pub(crate) allowed: Vec<Code>,
    /// The head of the report, where one is written.
    pub(crate) about: Option<About>,
}

impl Outcome {
    /// How the estimation ended.
    #[must_use]
    pub fn status(&self) -> CalibrationStatus {
        self.calibration.status
    }

    /// The warnings of the calibration.
    #[must_use]
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.calibration.warnings
    }

    /// A line for a table of many calibrations.
    #[must_use]
    pub fn summary(&self) -> Summary {
        Summary::of(&self.calibration)
    }

    /// The text of `calibration.json`.
    #[must_use]
    pub fn json(&self) -> String {
        calibration_json(&self.calibration, &self.validations, &self.inputs, &self.words())
    }

    /// Writes `calibration.json` into this directory, then `report.html` where the options ask for one. Each file is whole or absent.
    ///
    /// # Errors
    /// [`Error::Output`](crate::Error::Output) where a file cannot be written.
    pub fn write(&self, directory: &Path) -> Result<()> {
        let (json, report) = rayon::join(|| self.write_json(directory), || self.report_html());
        json?;
        match report {
            Some(html) => {
                write_atomically(&directory.join("report.html"), |out| out.write_all(html.as_bytes()))
            }
            None => Ok(()),
        }
    }

    /// How diagnostics are written to files.
    fn words(&self) -> DiagnosticWords<'_> {
        DiagnosticWords { message: &message, allowed: &self.allowed }
    }

    fn write_json(&self, directory: &Path) -> Result<()> {
        let path = directory.join("calibration.json");
        write_calibration(&path, &self.calibration, &self.validations, &self.inputs, &self.words())
    }

    /// The text of `report.html`, where one is written.
    fn report_html(&self) -> Option<String> {
        let about = self.about.as_ref()?;
        Some(calibration_report(&self.calibration, &self.recording, &self.noise, about))
    }
}
