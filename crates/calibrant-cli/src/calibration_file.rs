//! The options of all commands that read a calibration, in any format.

use crate::diagnostics::tell;
use calibrant::Result;
use calibrant::io::{
    CalibratedImuFile, ConventionOptions, ImuFormat, ImuUnit, RawUnits, read_calibrated_imu,
};
use calibrant::sensor::{CalibratedImu, SensorKind};
use std::path::Path;

/// The name of a format on the command line.
#[derive(Clone, Copy, clap::ValueEnum)]
pub(crate) enum Format {
    /// calibrant JSON.
    Calibrant,
    /// Kalibr's imu.yaml, scale-misalignment model.
    Kalibr,
    /// imu_tk's .calib, one file for each sensor.
    #[value(name = "imu_tk", alias = "imu-tk")]
    ImuTk,
    /// imucal's JSON.
    Imucal,
    /// A C header with the correction (reading: only headers that calibrant wrote).
    C,
    /// OpenVINS' kalibr_imu_chain.yaml, model kalibr.
    #[value(name = "openvins")]
    OpenVins,
    /// basalt's JSON (written).
    Basalt,
    /// PX4's parameters, for QGroundControl (written).
    Px4,
    /// ArduPilot's parameters (written).
    #[value(name = "ardupilot")]
    ArduPilot,
    /// imufusion's arrays, in Python (written).
    #[value(name = "imufusion")]
    ImuFusion,
    /// librealsense's calibration.json (written).
    #[value(name = "librealsense", alias = "realsense")]
    LibRealSense,
    /// The YAML of imu_calib, a node of ROS 1 and ROS 2, for the accelerometer (written).
    #[value(name = "imu_calib", alias = "ros2")]
    ImuCalib,
}

impl From<Format> for ImuFormat {
    fn from(format: Format) -> Self {
        match format {
            Format::Calibrant => Self::CalibrantJson,
            Format::Kalibr => Self::Kalibr,
            Format::ImuTk => Self::ImuTk,
            Format::Imucal => Self::Imucal,
            Format::C => Self::CHeader,
            Format::OpenVins => Self::OpenVins,
            Format::Basalt => Self::Basalt,
            Format::Px4 => Self::Px4,
            Format::ArduPilot => Self::ArduPilot,
            Format::ImuFusion => Self::ImuFusion,
            Format::LibRealSense => Self::LibRealSense,
            Format::ImuCalib => Self::ImuCalib,
        }
    }
}

/// What the file of a calibration may not state itself.
#[derive(clap::Args)]
pub(crate) struct Reading {
    #[command(flatten)]
    content: Content,
    /// Unit of the readings, if the file does not state it (imu_tk, some files of imucal): si, or counts.
    #[arg(long, value_parser = raw_units)]
    unit: Option<RawUnits>,
}

/// The same without the unit of the readings.
#[derive(clap::Args)]
pub(crate) struct Content {
    /// Format of the calibration (default: by its content).
    #[arg(long, value_enum)]
    from: Option<Format>,
    /// Sensor of a file of one sensor, if the file does not state it (imu_tk).
    #[arg(long, value_enum)]
    sensor: Option<Sensor>,
}

/// The unit of a calibration's readings: `si`, m/s² or rad/s in one of their usual spellings, or `counts`.
fn raw_units(text: &str) -> std::result::Result<RawUnits, String> {
    match (text, ImuUnit::parse(text)) {
        ("si", _) | (_, Some(ImuUnit::MetrePerSecondSquared | ImuUnit::RadianPerSecond)) => Ok(RawUnits::Si),
        (_, Some(ImuUnit::Counts)) => Ok(RawUnits::Counts),
        _ => Err("a calibration is of readings in m/s² and rad/s (si), or in counts".into()),
    }
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Sensor {
    Accelerometer,
    Gyroscope,
}

impl Reading {
    /// The sensor that the options name.
    pub(crate) fn sensor_kind(&self) -> Option<SensorKind> {
        self.content.sensor_kind()
    }

    /// Reads a calibration, and prints the findings of its reader.
    pub(crate) fn read(&self, path: &Path) -> Result<CalibratedImuFile> {
        self.content.read(path, self.unit)
    }
}

impl Content {
    /// The sensor that the options name.
    fn sensor_kind(&self) -> Option<SensorKind> {
        self.sensor.map(|sensor| match sensor {
            Sensor::Accelerometer => SensorKind::Accelerometer,
            Sensor::Gyroscope => SensorKind::Gyroscope,
        })
    }

    /// Reads a calibration of readings in this unit, if its file does not state another, and prints the findings of its reader.
    pub(crate) fn read(&self, path: &Path, units: Option<RawUnits>) -> Result<CalibratedImuFile> {
        let options = ConventionOptions {
            format: self.from.map(ImuFormat::from),
            units,
            sensor_kind: self.sensor_kind(),
        };
        let file = read_calibrated_imu(path, &options)?;
        for finding in &file.findings {
            tell(finding.clone().in_file(path.display().to_string()));
        }
        Ok(file)
    }
}

/// A calibration in one line: sensors, units, terms, covariance.
pub(crate) fn in_words(imu: &CalibratedImu) -> String {
    let mut words: Vec<String> = SensorKind::ALL
        .into_iter()
        .filter_map(|sensor_kind| Some(format!("{sensor_kind} in {}", imu.unit(sensor_kind)?.symbol())))
        .collect();
    if imu.unit(SensorKind::Gyroscope).is_some()
        && imu.parameters.g_sensitivity.iter().any(|&entry| entry != 0.0)
    {
        words.push("g-sensitivity".into());
    }
    if imu.follows_temperature() {
        words.push(format!("temperature terms about {} °C", imu.parameters.thermal.reference_c));
    }
    words.push(match &imu.covariance {
        Some(covariance) => format!("covariance of {} parameters", covariance.nrows()),
        None => "no covariance".into(),
    });
    words.join(", ")
}
