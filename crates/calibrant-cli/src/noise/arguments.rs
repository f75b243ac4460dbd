//! The arguments of `calibrant noise`.

use calibrant::sensor::SensorKind;
use nalgebra::Vector3;
use std::path::PathBuf;

/// Estimate the noise of a sensor at rest: Allan deviation, random walks, bias instability.
///
/// Examines the longest hold of the recording, or the interval of --hold, for both sensors of an IMU. A coefficient that the recording is too short to determine
/// is reported as not determined. Writes noise.json and report.html into DIR.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Recording, in any format that `calibrant inspect` knows, or columns t x y z of one sensor.
    pub(super) recording: PathBuf,
    /// The gyroscope's file, if each sensor has its own file (imu_tk).
    #[arg(long, value_name = "FILE")]
    pub(super) gyroscope: Option<PathBuf>,
    /// Examine only this sensor. It is also the sensor of columns t x y z (default: accelerometer).
    #[arg(long, value_enum)]
    pub(super) sensor: Option<SensorChoice>,
    #[command(flatten)]
    pub(super) reading: crate::recording_options::RecordingOptions,
    /// Experiment file whose [columns] name the columns.
    #[arg(long, value_name = "EXPERIMENT")]
    pub(super) columns: Option<PathBuf>,
    /// Nominal gain of the accelerometer, or of --sensor, in counts per m/s² or rad/s: one number or x,y,z. With it, the noise of counts is stated in SI and customary units.
    #[arg(long, value_name = "GAIN", value_delimiter = ',', num_args = 1..=3, allow_negative_numbers = true)]
    pub(super) gain: Vec<f64>,
    /// Nominal gain of the gyroscope, in addition to the accelerometer's.
    #[arg(long, value_name = "GAIN", value_delimiter = ',', num_args = 1..=3, allow_negative_numbers = true)]
    pub(super) gyroscope_gain: Vec<f64>,
    /// Start and end of the interval at rest, s (default: the longest hold that is found).
    #[arg(long, num_args = 2, value_names = ["START", "END"], allow_negative_numbers = true)]
    pub(super) hold: Option<Vec<f64>>,
    /// Print noise.json on stdout instead of the tables.
    #[arg(long)]
    pub(super) json: bool,
    /// Directory for noise.json and report.html.
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
pub(super) enum SensorChoice {
    Accelerometer,
    Gyroscope,
}

impl From<SensorChoice> for SensorKind {
    fn from(sensor: SensorChoice) -> Self {
        match sensor {
            SensorChoice::Accelerometer => Self::Accelerometer,
            SensorChoice::Gyroscope => Self::Gyroscope,
        }
    }
}

/// Gains by sensor.
pub(super) type Gains = Vec<(SensorKind, Vector3<f64>)>;
