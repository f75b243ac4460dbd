//! The formats of calibrations: their names, and how a file is recognised.

use super::words::invalid;
use calibrant_core::error::{InputError, Refusal, TaskOption};
use calibrant_recording::text::decoding::Checked;
use std::path::Path;

/// A format of calibrations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImuFormat {
    /// Our own, with everything. The reader also takes `truth.json` of a simulation.
    CalibrantJson,
    /// Kalibr's `imu.yaml` with the scale-misalignment model.
    Kalibr,
    /// imu_tk's `.calib`, one file for each sensor.
    ImuTk,
    /// imucal's JSON (`FerrarisCalibrationInfo`, `TurntableCalibrationInfo`).
    Imucal,
    /// A C header with the correction ready to apply.
    CHeader,
}

impl ImuFormat {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::CalibrantJson, Self::Kalibr, Self::ImuTk, Self::Imucal, Self::CHeader];

    /// Its name on the command line: `calibrant`, `kalibr`, `imu_tk`, `imucal`, `c`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::CalibrantJson => "calibrant",
            Self::Kalibr => "kalibr",
            Self::ImuTk => "imu_tk",
            Self::Imucal => "imucal",
            Self::CHeader => "c",
        }
    }

    /// Its name in a sentence.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::CalibrantJson => "calibrant JSON",
            Self::Kalibr => "Kalibr's imu.yaml",
            Self::ImuTk => "imu_tk's .calib",
            Self::Imucal => "imucal's JSON",
            Self::CHeader => "a C header",
        }
    }

    /// The format of this name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }

    /// The format in which a file of this name is written; `.json` is ours.
    #[must_use]
    pub fn of_extension(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "json" => Some(Self::CalibrantJson),
            "yaml" | "yml" => Some(Self::Kalibr),
            "calib" => Some(Self::ImuTk),
            "h" | "hpp" => Some(Self::CHeader),
            _ => None,
        }
    }

    /// The format of a text, by its content.
    pub(super) fn of_content(text: &str) -> Checked<Self> {
        let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'));
        let Some(first) = first.or_else(|| text.lines().map(str::trim).find(|line| !line.is_empty())) else {
            return Err(invalid("the file is empty", "give a calibration"));
        };
        let has = |word: &str| text.contains(word);
        if first.starts_with(['{', '[']) {
            let imucal = has("\"cal_type\"") || has("\"K_a\"");
            return Ok(if imucal { Self::Imucal } else { Self::CalibrantJson });
        }
        if has("CALIBRANT_REAL") || has("#ifndef") {
            return Ok(Self::CHeader);
        }
        if ["accelerometers:", "gyroscopes:", "_noise_density:", "T_i_b:", "C_gyro_i:"].into_iter().any(has) {
            return Ok(Self::Kalibr);
        }
        let numbers = first.split_whitespace().all(|word| word.parse::<f64>().is_ok());
        if numbers && !first.is_empty() {
            return Ok(Self::ImuTk);
        }
        let formats = ["calibrant", "kalibr", "imu_tk", "imucal", "c"];
        let help = format!("name its format with {}: {}", TaskOption::From, formats.join(", "));
        let message = "this is no calibration in a format that is known";
        let error = InputError::new(Refusal::CalibrationInvalid, message, help);
        Err(error.answered_by(TaskOption::From, formats).into())
    }
}
