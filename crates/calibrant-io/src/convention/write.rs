//! Writes a calibration in any format.

use super::file::{CalibratedImuFile, LARGEST, WrittenImu};
use super::prepared::Prepared;
use super::{
    ImuFormat, ardupilot, basalt, c_header, calibrant_json, imu_calib, imu_tk, imucal, imufusion, kalibr,
    librealsense, openvins, px4,
};
use calibrant_core::error::{Error, Result};
use calibrant_core::sensor::SensorKind;
use calibrant_recording::files::atomic_output::write_text;
use calibrant_recording::text::decoding::{self, Checked};
use std::path::Path;

/// Writes a calibration of an IMU in a format.
///
/// imu_tk's format has one file for each sensor: of a whole IMU, `NAME.calib` becomes `NAME_acc.calib` and `NAME_gyro.calib`.
///
/// # Errors
/// [`Error::Experiment`] with the reason where the format cannot carry the correction. [`Error::Output`]
/// where a file cannot be written.
pub fn write_calibrated_imu(path: &Path, file: &CalibratedImuFile, format: ImuFormat) -> Result<WrittenImu> {
    let (texts, prepared) = text_of(file, format).map_err(Error::Experiment)?;
    let mut files = Vec::new();
    for (sensor_kind, text) in &texts {
        let place = match sensor_kind {
            Some(sensor_kind) if texts.len() > 1 => imu_tk::name_of(path, *sensor_kind),
            _ => path.to_path_buf(),
        };
        write_text(&place, text)?;
        files.push(place);
    }
    Ok(prepared.written(files))
}

/// Writes a calibration into an existing file of basalt: its own keys are replaced, all other bytes stay.
///
/// # Errors
/// As [`write_calibrated_imu`]; and where the file cannot be read, or is none of basalt.
pub fn edit_calibrated_imu(path: &Path, file: &CalibratedImuFile) -> Result<WrittenImu> {
    let prepared = Prepared::of(file, ImuFormat::Basalt).map_err(Error::Experiment)?;
    let text = decoding::parsed(path, (LARGEST, "the calibration"), |bytes| {
        basalt::edited(decoding::as_text(bytes)?, &prepared.file)
    })?;
    write_text(path, &text)?;
    Ok(prepared.written(vec![path.to_path_buf()]))
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

type Texts = Vec<(Option<SensorKind>, String)>;

/// The text of each file, and what is written in it.
fn text_of(file: &CalibratedImuFile, format: ImuFormat) -> Checked<(Texts, Prepared)> {
    let mut prepared = Prepared::of(file, format)?;
    let Prepared { file, warnings } = &mut prepared;
    let one = |text: String| vec![(None, text)];
    let texts = match format {
        ImuFormat::CalibrantJson => one(calibrant_json::write(file)),
        ImuFormat::Kalibr => one(kalibr::write(file, warnings)?),
        ImuFormat::ImuTk => {
            imu_tk::write(file)?.into_iter().map(|(sensor_kind, text)| (Some(sensor_kind), text)).collect()
        }
        ImuFormat::Imucal => one(imucal::write(file)?),
        ImuFormat::CHeader => one(c_header::write(file)?),
        ImuFormat::OpenVins => one(openvins::write(file, warnings)?),
        ImuFormat::Basalt => one(basalt::write(file, warnings)?),
        ImuFormat::Px4 => one(px4::write(file, warnings)?),
        ImuFormat::ArduPilot => one(ardupilot::write(file)?),
        ImuFormat::ImuFusion => one(imufusion::write(file)?),
        ImuFormat::LibRealSense => one(librealsense::write(file)?),
        ImuFormat::ImuCalib => one(imu_calib::write(file)?),
    };
    Ok((texts, prepared))
}
