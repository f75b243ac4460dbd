//! The formats of calibrations: their names, and how a file is recognised.

use super::words::invalid;
use calibrant_core::error::{InputError, Refusal, TaskOption};
use calibrant_core::sensor::ImuPart;
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
    /// OpenVINS' `kalibr_imu_chain.yaml`.
    OpenVins,
    /// basalt's JSON.
    Basalt,
    /// PX4's parameters, as QGroundControl loads them.
    Px4,
    /// ArduPilot's parameters.
    ArduPilot,
    /// imufusion's arrays, in Python.
    ImuFusion,
    /// librealsense's `calibration.json`.
    LibRealSense,
    /// The YAML of imu_calib, a node of ROS 1 and ROS 2.
    ImuCalib,
}

impl ImuFormat {
    /// All formats.
    pub const ALL: [Self; 12] = [
        Self::CalibrantJson,
        Self::Kalibr,
        Self::ImuTk,
        Self::Imucal,
        Self::CHeader,
        Self::OpenVins,
        Self::Basalt,
        Self::Px4,
        Self::ArduPilot,
        Self::ImuFusion,
        Self::LibRealSense,
        Self::ImuCalib,
    ];

    /// Its name on the command line: `calibrant`, `kalibr`, `imu_tk`, `imucal`, `c`, `openvins`, `basalt`, `px4`, `ardupilot`, `imufusion`, `librealsense`, `imu_calib`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::CalibrantJson => "calibrant",
            Self::Kalibr => "kalibr",
            Self::ImuTk => "imu_tk",
            Self::Imucal => "imucal",
            Self::CHeader => "c",
            Self::OpenVins => "openvins",
            Self::Basalt => "basalt",
            Self::Px4 => "px4",
            Self::ArduPilot => "ardupilot",
            Self::ImuFusion => "imufusion",
            Self::LibRealSense => "librealsense",
            Self::ImuCalib => "imu_calib",
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
            Self::OpenVins => "OpenVINS' kalibr_imu_chain.yaml",
            Self::Basalt => "basalt's JSON",
            Self::Px4 => "PX4's parameters",
            Self::ArduPilot => "ArduPilot's parameters",
            Self::ImuFusion => "imufusion's arrays",
            Self::LibRealSense => "librealsense's calibration.json",
            Self::ImuCalib => "imu_calib's YAML",
        }
    }

    /// The format of this name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }

    /// The names of all formats, or of those that are read.
    #[must_use]
    pub fn names(read_only: bool) -> String {
        let names = Self::ALL.into_iter().filter(|format| !read_only || format.is_read());
        names.map(Self::name).collect::<Vec<_>>().join(", ")
    }

    /// Is it read, too?
    #[must_use]
    pub fn is_read(self) -> bool {
        use ImuFormat::{ArduPilot, Basalt, ImuCalib, ImuFusion, LibRealSense, Px4};
        !matches!(self, Basalt | Px4 | ArduPilot | ImuFusion | LibRealSense | ImuCalib)
    }

    /// The parts of a calibration that it has no place for.
    pub(super) fn lacks(self) -> &'static [ImuPart] {
        match self {
            Self::ImuTk | Self::Basalt | Self::ImuFusion | Self::LibRealSense => &[ImuPart::GSensitivity],
            Self::Px4 | Self::ArduPilot => &ImuPart::ALL,
            _ => &[],
        }
    }

    /// Has it a place for what temperature does?
    pub(super) fn follows_temperature(self) -> bool {
        matches!(self, Self::CalibrantJson | Self::CHeader | Self::Px4 | Self::ArduPilot)
    }

    /// Is it of readings in m/s² and rad/s alone?
    pub(super) fn is_physical(self) -> bool {
        !self.is_read() && self != Self::ImuFusion || self == Self::OpenVins
    }

    /// Is its true frame that of the accelerometer, whose matrix is lower triangular?
    pub(super) fn is_lower(self) -> bool {
        matches!(self, Self::OpenVins | Self::Basalt)
    }

    /// The format in which a file of this name is written; `.json` is ours.
    #[must_use]
    pub fn of_extension(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "json" => Some(Self::CalibrantJson),
            "yaml" | "yml" => Some(Self::Kalibr),
            "calib" => Some(Self::ImuTk),
            "h" | "hpp" => Some(Self::CHeader),
            "params" => Some(Self::Px4),
            "param" | "parm" => Some(Self::ArduPilot),
            "py" => Some(Self::ImuFusion),
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
        if has("R_IMUtoGYRO:") {
            return Ok(Self::OpenVins);
        }
        if ["accelerometers:", "gyroscopes:", "_noise_density:", "T_i_b:", "C_gyro_i:"].into_iter().any(has) {
            return Ok(Self::Kalibr);
        }
        let numbers = first.split_whitespace().all(|word| word.parse::<f64>().is_ok());
        if numbers && !first.is_empty() {
            return Ok(Self::ImuTk);
        }
        let formats = Self::ALL.into_iter().filter(|format| format.is_read()).map(Self::name);
        let help = format!("name its format with {}: {}", TaskOption::From, Self::names(true));
        let message = "this is no calibration in a format that is known";
        let error = InputError::new(Refusal::CalibrationInvalid, message, help);
        Err(error.answered_by(TaskOption::From, formats).into())
    }
}
