//! calibrant JSON, schema 2: reads and writes an IMU or one of its sensors, with everything.
//!
//! The direction is true → raw. The frame is in words, and by `gauge` where the matrix of the reference
//! sensor has such a form. The reference sensor is the accelerometer where there is one. Units are in the
//! names of the fields. The file carries everything: covariance, g-sensitivity, counts, noise densities, the
//! hashes of the recordings. Numbers have the fewest digits that read back to the same bits. The reader also
//! takes `truth.json` of a simulation.

use super::arrays::missing;
use super::imu_noise::ImuNoise;
use super::json_core::ImuCore;
use super::usable_calibration::{plausible_covariance, usable};
use super::words::{input_error, invalid};
use super::{CalibratedImuFile, ImuFormat, truth};
use crate::results::calibration::CalibrationFile;
use crate::results::campaign_calibration::CampaignCalibrationFile;
use crate::results::heading::{Heading, JsonFile, RECORD_KIND};
use crate::results::json;
use crate::results::machine_calibration::MachineCalibrationFile;
use calibrant_core::diagnostic::convention::{FormatSupposed, VerdictBad};
use calibrant_core::diagnostic::{Diagnostic, Phrase, Usability};
use calibrant_core::error::{InputError, Refusal};
use calibrant_core::estimate::CalibrationStatus;
use calibrant_core::json::{flat, if_some};
use calibrant_core::json_object;
use calibrant_core::sensor::{CalibratedImu, ImuFields};
use calibrant_recording::text::decoding::Checked;
use serde::Deserialize;
use serde::de::IgnoredAny;

/// The kinds of files with a calibration. All said `calibration` once.
const KINDS: [&str; 5] = [
    CalibrationFile::KIND,
    CampaignCalibrationFile::KIND,
    MachineCalibrationFile::KIND,
    ConvertedFile::KIND,
    RECORD_KIND,
];
/// The remedy for a broken file, or one of another kind.
const HELP: &str = "give a calibration.json that `calibrant calibrate` wrote";

/// A calibrated IMU as calibrant JSON.
#[derive(Debug, Clone, Copy)]
pub struct ConvertedFile<'a>(pub(super) &'a CalibratedImuFile);

json_object! {
    /// A calibrated IMU.
    ConvertedFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        imu: flat(ImuFields::of(file.0.imu.clone())),
        inputs: &file.0.inputs,
        noise: if_some(file.0.noise.as_ref()),
    }
}

impl JsonFile for ConvertedFile<'_> {
    const KIND: &'static str = "converted";
}

/// The fields beside the core. A file of the estimator has more, which this reader ignores.
#[derive(Deserialize)]
pub(super) struct Header {
    schema: Option<serde_json::Value>,
    kind: Option<String>,
    status: Option<String>,
    verdict: Option<serde_json::Value>,
    station: Option<String>,
    prior: Option<String>,
    /// What was found of a machine.
    machine: Option<IgnoredAny>,
    /// Only the file of a simulation has one.
    seed: Option<serde_json::Value>,
    noise: Option<ImuNoise>,
}

pub(super) fn write(file: &CalibratedImuFile) -> String {
    json::to_json(&ConvertedFile(file))
}

pub(super) fn read(text: &str) -> Checked<CalibratedImuFile> {
    let header = Header::of(text)?;
    if header.is_truth() {
        return truth::read(text);
    }
    let core = header.core(text)?;
    if core.has_one_axis() {
        return Err(input_error(
            Refusal::CalibrationUnsuited,
            "this is the calibration of a sensor with one axis; an IMU has three",
            "use its parameters from the file itself",
        ));
    }
    let (imu, inputs) = core.into_imu()?;
    let findings = header.findings();
    let noise = header.noise.map(ImuNoise::checked).transpose()?;
    let (station, format) = (header.station, ImuFormat::CalibrantJson);
    Ok(CalibratedImuFile { imu, noise, inputs, station, format, findings })
}

/// The calibrated sensors of a `calibration.json`, also one of a single axis, and whether the datasheet was
/// their prior.
pub(crate) fn read_estimates(text: &str) -> Checked<(CalibratedImu, bool)> {
    let header = Header::of(text)?;
    let (imu, _) = header.core(text)?.into_imu()?;
    usable(&imu)?;
    Ok((imu, header.prior.as_deref() == Some("datasheet")))
}

/// The sensors of the text of a `calibration.json`, also of one that did not converge or cannot be used.
///
/// # Errors
/// The text is no calibration of calibrant, or contradicts itself.
pub fn parse_estimates(text: &str) -> Checked<CalibratedImu> {
    let header = Header { status: None, ..Header::of(text)? };
    let (imu, _) = header.core(text)?.into_imu()?;
    plausible_covariance(&imu)?;
    Ok(imu)
}

impl Header {
    pub(super) fn of(text: &str) -> Checked<Self> {
        serde_json::from_str(text).map_err(|error| broken(&error))
    }

    /// Is it the file of a simulation? Only that has a seed.
    fn is_truth(&self) -> bool {
        self.seed.is_some()
    }

    /// Is it the calibration of a campaign?
    pub(super) fn is_of_several_soaks(&self) -> bool {
        self.kind.as_deref() == Some(CampaignCalibrationFile::KIND)
    }

    /// Did it converge, or is there nothing to converge?
    fn has_converged(&self) -> bool {
        self.status.as_ref().is_none_or(|status| status == CalibrationStatus::Converged.name())
    }

    /// What is missing, and a verdict that forbids its use.
    pub(super) fn findings(&self) -> Vec<Diagnostic> {
        let mut findings: Vec<Diagnostic> = Vec::new();
        let mut supposed = |what, supposed: &str| {
            findings.push(FormatSupposed { what, supposed: Phrase(supposed.to_owned()) }.into());
        };
        if self.kind.is_none() {
            supposed("its kind", "it is taken for a calibration");
        }
        let is_judged =
            [CalibrationFile::KIND, CampaignCalibrationFile::KIND, MachineCalibrationFile::KIND, RECORD_KIND];
        let usability = self.verdict.as_ref().and_then(|verdict| verdict["usability"].as_str());
        let is_one_of_them = self.kind.as_ref().is_none_or(|kind| is_judged.contains(&kind.as_str()));
        if usability.is_none() && is_one_of_them {
            supposed("a verdict", "nobody says that it may be used");
        }
        if let Some(verdict) = self.verdict.as_ref().filter(|_| usability == Some(Usability::Bad.name())) {
            let codes = verdict["codes"].as_array().into_iter().flatten();
            let codes = codes.filter_map(|code| Some(code.as_str()?.to_owned())).collect();
            findings.push(VerdictBad { codes }.into());
        }
        findings
    }

    /// The core of a file of this schema, of a calibration that converged.
    pub(super) fn core(&self, text: &str) -> Checked<ImuCore> {
        if self.is_truth() {
            let message = "this is the truth of a simulation, not a calibration: it has no covariance";
            return Err(invalid(message, HELP));
        }
        match &self.schema {
            Some(schema) if *schema == json::SCHEMA => (),
            Some(schema) if *schema == 1 => return Err(obsolete()),
            Some(schema) => {
                let message = format!("schema {schema} of a calibration is not known to this version");
                return Err(invalid(message, "use a newer calibrant"));
            }
            None => return Err(missing("schema")),
        }
        if let Some(kind) = self.kind.as_ref().filter(|kind| !KINDS.contains(&kind.as_str())) {
            let message = format!("the kind of this file is {kind:?}, and that is no calibration");
            return Err(invalid(message, HELP));
        }
        if self.kind.as_deref() == Some(MachineCalibrationFile::KIND) && self.machine.is_none() {
            let message =
                "the kind of this file is \"machine\", and it has no `machine`: it is of another kind";
            return Err(invalid(message, HELP));
        }
        if let Some(status) = self.status.as_ref().filter(|_| !self.has_converged()) {
            let message = format!("this calibration did not converge: its status is \"{status}\"");
            return Err(invalid(message, "calibrate again; its report says what is wrong"));
        }
        serde_json::from_str(text).map_err(|error| broken(&error))
    }
}

pub(super) fn broken(error: &serde_json::Error) -> Box<InputError> {
    json::broken(error, "a calibration of calibrant", HELP).into()
}

/// The error for a file of schema 1, in which earlier versions wrote the calibration of an accelerometer.
fn obsolete() -> Box<InputError> {
    invalid(
        "schema 1 of calibration.json is that of an earlier calibrant: its parameters have other names",
        "calibrate the recording again with this version",
    )
}
