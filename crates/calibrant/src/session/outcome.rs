//! What comes of a recording, and the files that it is written to.

use super::calibrated::{Calibrated, MachineOutcome};
use calibrant_core::acceptance::CheckedLimit;
use calibrant_core::diagnostic::{Code, Diagnostic, Verdict};
use calibrant_core::error::Result;
use calibrant_core::estimate::{Calibration, CalibrationStatus, Validation};
use calibrant_core::noise::SensorNoise;
use calibrant_core::sensor::ImuRecording;
use calibrant_io::{
    CalibrationFile, Judgement, MachineCalibrationFile, Origin, Summary, to_json, write_json, write_text,
};
use calibrant_report::{About, Sheet, calibration_sheet, machine_sheet};
use std::path::Path;

/// A calibration with everything that stands beside it.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The calibration.
    pub calibrated: Calibrated,
    /// How it fares on data that it is not from, where the options ask for it. That of a machine is in `calibrated`.
    pub validations: Vec<Validation>,
    /// The noise of an IMU in its longest hold, in m/s² and rad/s, as the report shows it. Empty without a report.
    pub noise: Vec<SensorNoise>,
    /// What was noticed, in the order in which people should read it. Warnings of the calibration are in itself.
    pub notes: Vec<Diagnostic>,
    /// The sensor, and the files that were read.
    pub origin: Origin,
    /// The limits that were checked.
    pub limits: Vec<CheckedLimit>,
    /// Codes of what the reader noticed in the recording.
    pub(crate) findings: Vec<Code>,
    /// The recording, cleaned: without spikes and invalid readings.
    pub recording: ImuRecording,
    /// Diagnostics that the files mark as allowed.
    pub(crate) allowed: Vec<Code>,
    /// What a sheet says beside the calibration.
    pub(crate) about: About,
    /// Is a page written?
    pub(crate) with_page: bool,
}

impl Outcome {
    /// The calibration, whatever moved the sensors.
    #[must_use]
    pub fn calibration(&self) -> &Calibration {
        self.calibrated.sensors()
    }

    /// How the estimation ended.
    #[must_use]
    pub fn status(&self) -> CalibrationStatus {
        self.calibration().status
    }

    /// The warnings of the calibration.
    #[must_use]
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.calibration().warnings
    }

    /// May the result be used? The warnings and what the reader noticed decide.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let codes = self.warnings().iter().map(Diagnostic::code).chain(self.findings.iter().copied());
        Verdict::on(codes, &self.allowed)
    }

    /// A line for a table of many calibrations.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let used_share = self.calibrated.machine().map(|machine| machine.calibration.used_share);
        Summary::of(self.calibration(), used_share).judged(self.verdict(), &self.limits)
    }

    /// The text of `calibration.json`.
    #[must_use]
    pub fn json(&self) -> String {
        match &self.calibrated {
            Calibrated::Sensors(calibration) => {
                to_json(&CalibrationFile::of(calibration, &self.validations, &self.origin, &self.judgement()))
            }
            Calibrated::OnMachine(machine) => to_json(&self.machine_file(machine)),
        }
    }

    /// Writes `calibration.json` into this directory, then `report.html` where the options ask for one. Each file is whole or absent.
    ///
    /// # Errors
    /// [`Error::Output`](crate::Error::Output) where a file cannot be written.
    pub fn write(&self, directory: &Path) -> Result<()> {
        self.write_with(directory, None)
    }

    /// The same, where the text of `calibration.json` is there.
    pub(crate) fn write_with(&self, directory: &Path, json: Option<&str>) -> Result<()> {
        let write_json = || match json {
            Some(text) => write_text(&directory.join("calibration.json"), text),
            None => self.write_json(directory),
        };
        let (json, report) = rayon::join(write_json, || self.with_page.then(|| self.report_html()));
        json?;
        match report {
            Some(html) => write_text(&directory.join("report.html"), &html),
            None => Ok(()),
        }
    }

    /// What judges the result.
    fn judgement(&self) -> Judgement<'_> {
        Judgement { allowed: &self.allowed, findings: &self.findings, limits: &self.limits }
    }

    fn machine_file<'a>(&'a self, machine: &'a MachineOutcome) -> MachineCalibrationFile<'a> {
        MachineCalibrationFile { result: machine.result(), origin: &self.origin, judgement: self.judgement() }
    }

    fn write_json(&self, directory: &Path) -> Result<()> {
        let path = directory.join("calibration.json");
        match &self.calibrated {
            Calibrated::Sensors(calibration) => write_json(
                &path,
                &CalibrationFile::of(calibration, &self.validations, &self.origin, &self.judgement()),
            ),
            Calibrated::OnMachine(machine) => write_json(&path, &self.machine_file(machine)),
        }
    }

    /// The calibration for people: as text for a terminal, or as a page.
    #[must_use]
    pub fn sheet(&self) -> Sheet<'_> {
        match &self.calibrated {
            Calibrated::Sensors(calibration) => {
                calibration_sheet(calibration, &self.recording, &self.noise, &self.about)
            }
            Calibrated::OnMachine(machine) => {
                let MachineOutcome { calibration, setup, validations, .. } = machine.as_ref();
                machine_sheet(calibration, setup, validations, &self.recording, &self.about)
            }
        }
    }

    /// The text of `report.html`, which begins as a certificate does.
    #[must_use]
    pub fn report_html(&self) -> String {
        let sheet = self.sheet();
        // of several sensors whose files have one name, each title says which it is
        let title = match &self.origin.sensor {
            Some(sensor) if !sheet.title.contains(sensor.as_str()) => format!("{sensor}: {}", sheet.title),
            _ => sheet.title.clone(),
        };
        Sheet { title, head: self.head(), ..sheet }.html()
    }
}
