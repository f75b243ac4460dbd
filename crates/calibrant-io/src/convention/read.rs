//! Reads a calibration in any format: recognises the format, calls its reader, checks the result.

use super::file::{CalibratedImuFile, LARGEST};
use super::options::ConventionOptions;
use super::words::invalid;
use super::{ImuFormat, c_header, calibrant_json, imu_tk, imucal, kalibr, openvins, usable_calibration};
use calibrant_core::diagnostic::convention::UnitGiven;
use calibrant_core::error::{Error, Result};
use calibrant_core::sensor::SensorKind;
use calibrant_recording::text::decoding::{self, Checked};
use std::path::{Path, PathBuf};

/// Reads a calibration of an IMU in any of the formats.
///
/// A name `NAME.calib` that does not exist stands for imu_tk's pair `NAME_acc.calib` and `NAME_gyro.calib`.
///
/// # Errors
/// [`Error::Experiment`] with the file, and line and column where they are known. The file cannot be read, or
/// its format is not recognised. Fields are missing or not numbers. A matrix is singular. Neither the file
/// nor the options state a unit or a sensor.
pub fn read_calibrated_imu(path: &Path, options: &ConventionOptions) -> Result<CalibratedImuFile> {
    if let Some(pair) = imu_tk::pair_instead_of(path) {
        let read = |path: &PathBuf, sensor_kind| {
            read_one(
                path,
                &ConventionOptions {
                    format: Some(ImuFormat::ImuTk),
                    sensor_kind: Some(sensor_kind),
                    ..*options
                },
            )
        };
        let (accelerometer, gyroscope) =
            (read(&pair[0], SensorKind::Accelerometer)?, read(&pair[1], SensorKind::Gyroscope)?);
        return Ok(imu_tk::joined(accelerometer, gyroscope));
    }
    let sensor_kind = options.sensor_kind.or_else(|| imu_tk::sensor_kind_of_name(path));
    read_one(path, &ConventionOptions { sensor_kind, ..*options })
}

fn read_one(path: &Path, options: &ConventionOptions) -> Result<CalibratedImuFile> {
    decoding::parsed(path, (LARGEST, "the calibration"), |bytes| parse(bytes, options))
}

/// Reads the bytes of a calibration of an IMU.
///
/// # Errors
/// As [`read_calibrated_imu`], without the name of the file.
///
/// # Examples
/// An accelerometer in imu_tk's form: misalignment, scale, bias.
/// ```
/// use calibrant_io::{ConventionOptions, RawUnits, parse_calibrated_imu};
/// use calibrant_core::sensor::SensorKind;
///
/// let text = "1 0 0\n0 1 0\n0 0 1\n\n0.0024 0 0\n0 0.0024 0\n0 0 0.0024\n\n33124\n33275\n32364\n";
/// let options = ConventionOptions { units: Some(RawUnits::Counts), sensor_kind: Some(SensorKind::Accelerometer), ..Default::default() };
/// let file = parse_calibrated_imu(text.as_bytes(), &options)?;
/// assert!((file.imu.parameters[SensorKind::Accelerometer].matrix[(0, 0)] - 1.0 / 0.0024).abs() < 1e-9, "counts per m/s²");
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_calibrated_imu(bytes: &[u8], options: &ConventionOptions) -> Result<CalibratedImuFile> {
    parse(bytes, options).map_err(Error::Experiment)
}

fn parse(bytes: &[u8], options: &ConventionOptions) -> Checked<CalibratedImuFile> {
    let text = decoding::as_text(bytes)?;
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
        ImuFormat::OpenVins => openvins::read(text)?,
        written => {
            let message = format!("{} is written and not read", written.title());
            return Err(invalid(message, &format!("give one of {}", ImuFormat::names(true))));
        }
    };
    usable_calibration::usable(&file.imu)?;
    for sensor_kind in SensorKind::ALL {
        let given = options.units.map(|units| units.unit(sensor_kind));
        if let (Some(stated), Some(given)) = (file.imu.unit(sensor_kind), given)
            && stated != given
        {
            file.findings.push(UnitGiven { sensor_kind, stated, given }.into());
        }
    }
    Ok(file)
}
