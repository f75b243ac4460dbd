//! Calibrations of an IMU in the formats of other programs, and in our own.
//!
//! | format | file | direction | true frame | units of readings | cannot carry |
//! |---|---|---|---|---|---|
//! | [`CalibrantJson`](ImuFormat::CalibrantJson) | `.json` | true → raw | any, said in words and by its gauge | m/s², rad/s, counts | |
//! | [`Kalibr`](ImuFormat::Kalibr) | `imu.yaml` | true → raw | `M` lower triangular; another frame through `T_i_b` | m/s², rad/s | covariance; temperature; biases and counts only in keys that Kalibr does not read |
//! | [`ImuTk`](ImuFormat::ImuTk) | `.calib`, one for each sensor | raw → true | any; its own results have the upper gauge | not said | covariance, g-sensitivity, temperature |
//! | [`Imucal`](ImuFormat::Imucal) | `.json` with `cal_type` | true → raw | any | named; true rates in deg/s | covariance; temperature; one sensor alone |
//! | [`CHeader`](ImuFormat::CHeader) | `.h` | raw → true | any, said in words | named | covariance |
//!
//! What a format cannot carry is told as a warning when it is written, and refused where the correction itself would change. What a reader had to
//! suppose is told as a finding; what is ambiguous (the unit of imu_tk's readings) is asked.

mod c_header;
mod c_temperature;
mod calibrant_json;
mod check;
mod core;
mod format;
mod imu_tk;
mod imucal;
mod kalibr;
mod measured_noise;
mod schema_one;
mod temperature;
mod truth;

pub(in crate::io) use calibrant_json::Heading;
pub(in crate::io) use core::ImuCore;
pub use format::ImuFormat;
pub use kalibr::{ImuNoise, read_kalibr_noise};
pub use measured_noise::read_measured_noise;

use super::calibration::Input;
use super::output::write_atomically;
use super::text::{self, Checked};
use crate::error::{Complaint, Error, Result};
use crate::sensor::{CalibratedImu, ReadingUnit, Triad};
use std::path::{Path, PathBuf};

/// Largest file of a calibration, bytes.
const LARGEST: u64 = 64 << 20;

/// A calibrated IMU as it stands in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedImuFile {
    /// The calibration.
    pub imu: CalibratedImu,
    /// Noise densities, where the file has them.
    pub noise: Option<ImuNoise>,
    /// The recordings that it came from, where the file says so.
    pub inputs: Vec<Input>,
    /// The format that it was read from.
    pub format: ImuFormat,
    /// What the reader supposed or left out.
    pub findings: Vec<String>,
}

/// What the readings are, where a file does not say it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RawUnits {
    /// m/s² and rad/s.
    Si,
    /// Counts.
    Counts,
}

impl RawUnits {
    /// The unit of a sensor's readings.
    #[must_use]
    pub fn of(self, triad: Triad) -> ReadingUnit {
        match self {
            Self::Si => triad.stimulus_unit(),
            Self::Counts => ReadingUnit::Counts,
        }
    }
}

/// How a calibration is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ConventionOptions {
    /// The format; by content where it is not given.
    pub format: Option<ImuFormat>,
    /// Unit of the readings, for files that do not say.
    pub units: Option<RawUnits>,
    /// The sensor, for files of one sensor that do not say which.
    pub triad: Option<Triad>,
}

/// What was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenImu {
    /// The files.
    pub files: Vec<PathBuf>,
    /// What the format cannot carry.
    pub warnings: Vec<String>,
}

/// Reads a calibration of an IMU in any of the formats.
///
/// A name `NAME.calib` that does not exist stands for imu_tk's pair `NAME_acc.calib` and `NAME_gyro.calib`.
///
/// # Errors
/// [`Error::Experiment`] with the file, and line and column where they are known: a file that cannot be read; a format that is not recognised; fields
/// that are missing or no numbers; a matrix that is singular; a unit or a sensor that the file does not say and the options do not either.
pub fn read_calibrated_imu(path: &Path, options: &ConventionOptions) -> Result<CalibratedImuFile> {
    if let Some(pair) = imu_tk::pair_instead_of(path) {
        let read = |path: &PathBuf, triad| {
            read_one(
                path,
                &ConventionOptions { format: Some(ImuFormat::ImuTk), triad: Some(triad), ..*options },
            )
        };
        let (accelerometer, gyroscope) =
            (read(&pair[0], Triad::Accelerometer)?, read(&pair[1], Triad::Gyroscope)?);
        return Ok(imu_tk::joined(accelerometer, gyroscope));
    }
    let triad = options.triad.or_else(|| imu_tk::triad_of_name(path));
    read_one(path, &ConventionOptions { triad, ..*options })
}

fn read_one(path: &Path, options: &ConventionOptions) -> Result<CalibratedImuFile> {
    let bytes = text::read_bytes(path, LARGEST, "the calibration")
        .map_err(|complaint| Error::experiment(*complaint))?;
    parse(&bytes, options).map_err(|complaint| Error::experiment(complaint.in_file(path)))
}

/// Reads the bytes of a calibration of an IMU.
///
/// # Errors
/// As [`read_calibrated_imu`], without the name of the file.
///
/// # Examples
/// An accelerometer as imu_tk writes it: misalignment, scale, bias.
/// ```
/// use calibrant::io::{ConventionOptions, RawUnits, parse_calibrated_imu};
/// use calibrant::sensor::Triad;
///
/// let text = "1 0 0\n0 1 0\n0 0 1\n\n0.0024 0 0\n0 0.0024 0\n0 0 0.0024\n\n33124\n33275\n32364\n";
/// let options = ConventionOptions { units: Some(RawUnits::Counts), triad: Some(Triad::Accelerometer), ..Default::default() };
/// let file = parse_calibrated_imu(text.as_bytes(), &options)?;
/// assert!((file.imu.parameters.accelerometer.matrix[(0, 0)] - 1.0 / 0.0024).abs() < 1e-9, "counts per m/s²");
/// # Ok::<(), calibrant::Error>(())
/// ```
pub fn parse_calibrated_imu(bytes: &[u8], options: &ConventionOptions) -> Result<CalibratedImuFile> {
    parse(bytes, options).map_err(|complaint| Error::experiment(*complaint))
}

fn parse(bytes: &[u8], options: &ConventionOptions) -> Checked<CalibratedImuFile> {
    let text = text::as_text(bytes)?;
    let format = match options.format {
        Some(format) => format,
        None => ImuFormat::of_content(text)?,
    };
    let mut file = match format {
        ImuFormat::CalibrantJson => calibrant_json::read(text)?,
        ImuFormat::Kalibr => kalibr::read(text, options)?,
        ImuFormat::ImuTk => imu_tk::read(text, options)?,
        ImuFormat::Imucal => imucal::read(text, options)?,
        ImuFormat::CHeader => c_header::read(text)?,
    };
    check::usable(&file.imu)?;
    for triad in Triad::ALL {
        let given = options.units.map(|units| units.of(triad));
        if let (Some(said), Some(given)) = (file.imu.unit(triad), given)
            && said != given
        {
            file.findings.push(format!(
                "the readings of the {triad} are in {}, as the file says: the unit {} is given for files that do not say it",
                said.symbol(),
                given.symbol()
            ));
        }
    }
    Ok(file)
}

/// Writes a calibration of an IMU in a format.
///
/// imu_tk's format has one file for each sensor: of a whole IMU, `NAME.calib` becomes `NAME_acc.calib` and `NAME_gyro.calib`.
///
/// # Errors
/// [`Error::Experiment`] where the format cannot carry the correction, with the reason; [`Error::Output`] where a file cannot be written.
pub fn write_calibrated_imu(path: &Path, file: &CalibratedImuFile, format: ImuFormat) -> Result<WrittenImu> {
    let (texts, warnings) = text_of(file, format).map_err(|complaint| Error::experiment(*complaint))?;
    let mut files = Vec::new();
    for (triad, text) in &texts {
        let place = match triad {
            Some(triad) if texts.len() > 1 => imu_tk::name_of(path, *triad),
            _ => path.to_path_buf(),
        };
        write_atomically(&place, |out| out.write_all(text.as_bytes()))?;
        files.push(place);
    }
    Ok(WrittenImu { files, warnings })
}

/// The text that [`write_calibrated_imu`] writes: one for each file, with the sensor where a file is of one sensor.
///
/// # Errors
/// [`Error::Experiment`] where the format cannot carry the correction.
pub fn calibrated_imu_texts(
    file: &CalibratedImuFile,
    format: ImuFormat,
) -> Result<Vec<(Option<Triad>, String)>> {
    text_of(file, format).map(|(texts, _)| texts).map_err(|complaint| Error::experiment(*complaint))
}

type Texts = (Vec<(Option<Triad>, String)>, Vec<String>);

fn text_of(file: &CalibratedImuFile, format: ImuFormat) -> Checked<Texts> {
    check::usable(&file.imu)?;
    let mut warnings = Vec::new();
    if format != ImuFormat::CalibrantJson && file.imu.covariance.is_some() {
        warnings.push(format!(
            "{} has no place for the covariance: keep the calibrant JSON for the standard deviations",
            format.title()
        ));
    }
    if file.imu.follows_temperature() && !matches!(format, ImuFormat::CalibrantJson | ImuFormat::CHeader) {
        return Err(complaint(
            format!(
                "{} has no place for what temperature does to bias and gain, and the correction would be another without it",
                format.title()
            ),
            "choose another format, or take the values at one temperature with --temperature CELSIUS",
        ));
    }
    let one = |text: String| vec![(None, text)];
    let texts = match format {
        ImuFormat::CalibrantJson => one(calibrant_json::write(file)),
        ImuFormat::Kalibr => one(kalibr::write(file, &mut warnings)?),
        ImuFormat::ImuTk => {
            imu_tk::write(file)?.into_iter().map(|(triad, text)| (Some(triad), text)).collect()
        }
        ImuFormat::Imucal => one(imucal::write(file)?),
        ImuFormat::CHeader => one(c_header::write(file)?),
    };
    if let Some(noise) = &file.noise {
        warnings.extend(match format {
            ImuFormat::CalibrantJson | ImuFormat::Kalibr => noise.of_rates(),
            _ => Some(format!("{} has no place for the noise densities", format.title())),
        });
    }
    Ok((texts, warnings))
}

/// Program and version, for the first line of a file.
fn written_by() -> String {
    format!("written by calibrant {}", env!("CARGO_PKG_VERSION"))
}

/// A complaint without a place.
fn complaint(message: impl Into<String>, help: &str) -> Box<Complaint> {
    Box::new(Complaint::new(message, help))
}
