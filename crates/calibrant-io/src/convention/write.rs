//! Writes a calibration in any format.

use super::file::{CalibratedImuFile, WrittenImu};
use super::words::input_error;
use super::{ImuFormat, c_header, calibrant_json, imu_tk, imucal, kalibr, usable_calibration};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::convention::{FormatLoses, ResponseStraightened};
use calibrant_core::error::{Error, Refusal, Result};
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::SensorKind;
use calibrant_recording::files::atomic_output::write_text;
use calibrant_recording::text::decoding::Checked;
use std::path::Path;

/// Writes a calibration of an IMU in a format.
///
/// imu_tk's format has one file for each sensor: of a whole IMU, `NAME.calib` becomes `NAME_acc.calib` and `NAME_gyro.calib`.
///
/// # Errors
/// [`Error::Experiment`] with the reason where the format cannot carry the correction. [`Error::Output`]
/// where a file cannot be written.
pub fn write_calibrated_imu(path: &Path, file: &CalibratedImuFile, format: ImuFormat) -> Result<WrittenImu> {
    let (texts, warnings) = text_of(file, format).map_err(Error::Experiment)?;
    let mut files = Vec::new();
    for (sensor_kind, text) in &texts {
        let place = match sensor_kind {
            Some(sensor_kind) if texts.len() > 1 => imu_tk::name_of(path, *sensor_kind),
            _ => path.to_path_buf(),
        };
        write_text(&place, text)?;
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
) -> Result<Vec<(Option<SensorKind>, String)>> {
    text_of(file, format).map(|(texts, _)| texts).map_err(Error::Experiment)
}

type Texts = (Vec<(Option<SensorKind>, String)>, Vec<Diagnostic>);

fn text_of(file: &CalibratedImuFile, format: ImuFormat) -> Checked<Texts> {
    usable_calibration::usable(&file.imu)?;
    let mut warnings: Vec<Diagnostic> = Vec::new();
    let loses = |what| FormatLoses { format: format.title(), what, is_beside: false }.into();
    if format != ImuFormat::CalibrantJson && file.imu.covariance.is_some() {
        warnings.push(loses("the covariance"));
    }
    if file.imu.follows_temperature() && !matches!(format, ImuFormat::CalibrantJson | ImuFormat::CHeader) {
        return Err(input_error(
            Refusal::ConversionImpossible,
            format!(
                "{} has no place for what temperature does to bias and gain, and the correction would be another without it",
                format.title()
            ),
            "choose another format, or take the values at one temperature with option `temperature` CELSIUS",
        ));
    }
    let bends = &file.imu.parameters[SensorKind::Accelerometer].nonlinearity;
    if !bends.is_none() && !matches!(format, ImuFormat::CalibrantJson | ImuFormat::CHeader) {
        let of_axis = |axis: usize| {
            [1.0, -1.0].map(|sign| bends.bend(axis, sign * Gravity::SOMEWHERE.magnitude_mps2).abs())
        };
        let largest_mps2 = (0..3).flat_map(of_axis).fold(0.0, f64::max);
        warnings.push(ResponseStraightened { format: format.title(), largest_mps2 }.into());
    }
    let one = |text: String| vec![(None, text)];
    let texts = match format {
        ImuFormat::CalibrantJson => one(calibrant_json::write(file)),
        ImuFormat::Kalibr => one(kalibr::write(file, &mut warnings)?),
        ImuFormat::ImuTk => {
            imu_tk::write(file)?.into_iter().map(|(sensor_kind, text)| (Some(sensor_kind), text)).collect()
        }
        ImuFormat::Imucal => one(imucal::write(file)?),
        ImuFormat::CHeader => one(c_header::write(file)?),
    };
    if let Some(noise) = &file.noise {
        warnings.extend(match format {
            ImuFormat::CalibrantJson | ImuFormat::Kalibr => noise.of_rates(),
            _ => Some(loses("the noise densities")),
        });
    }
    Ok((texts, warnings))
}
