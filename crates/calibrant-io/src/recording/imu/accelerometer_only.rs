//! Reads the accelerometer alone, from a recording in any format.

use super::read::parse;
use super::text_header::Head;
use super::text_source::whole;
use super::{FileFormat, ImuReadOptions, ImuUnit};
use crate::recording::columns::is_axis;
use crate::recording::read::parse as parse_plain;
use crate::recording::{ReadOptions, RecordingFile};
use crate::text_decoding;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{Axis, ReadingUnit, SensorKind};
use std::path::Path;

/// Reads the accelerometer of a recording. The file is a text of the accelerometer alone, as
/// [`read_recording`](crate::read_recording) reads it, or any file for
/// [`read_imu_recording`](super::read_imu_recording). The content decides, unless `device` states something.
///
/// # Errors
/// As these two. [`Error::Recording`] also where the file has no accelerometer.
pub fn read_accelerometer(
    path: &Path,
    options: &ReadOptions,
    device: &ImuReadOptions,
) -> Result<RecordingFile> {
    let in_file = |input_error: Box<InputError>| Error::recording(input_error.in_file(path));
    let bytes = whole(path).map_err(in_file)?;
    if *device == ImuReadOptions::default() && is_plain(&bytes) {
        return parse_plain(&bytes, options).map_err(in_file);
    }
    let expected = (options.expected_unit == ReadingUnit::Counts).then_some(ImuUnit::Counts);
    let given = options.unit.map(|unit| match unit {
        ReadingUnit::Counts => ImuUnit::Counts,
        _ => ImuUnit::MetrePerSecondSquared,
    });
    let device = ImuReadOptions {
        accelerometer_unit: given.or(device.accelerometer_unit).or(expected),
        ..device.clone()
    };
    let file = parse(&bytes, &device).map_err(in_file)?;
    let Some(mut recording) = file.recording.accelerometer else {
        let input_error = InputError::new(
            Refusal::SensorMissing,
            format!("the recording has no {}", SensorKind::Accelerometer),
            "`calibrant inspect` says what it has",
        );
        return Err(in_file(input_error.into()));
    };
    recording.axes = options.axes;
    for axis in &Axis::ALL[options.axes..] {
        recording.readings.iter_mut().for_each(|reading| reading[axis.index()] = 0.0);
    }
    Ok(RecordingFile { recording, findings: file.findings, sha256: file.sha256.concat(), lines: file.rows })
}

/// Is this the text of one accelerometer, `t_s,ax,ay,az` or `t x y z`?
fn is_plain(bytes: &[u8]) -> bool {
    if FileFormat::of_magic(bytes).is_some() || bytes.trim_ascii_start().starts_with(b"{") {
        return false;
    }
    // the plain reader reports a file that is no text at all, or has no rows
    let Some(head) = text_decoding::as_text(bytes).ok().and_then(|text| Head::find(text).ok()) else {
        return true;
    };
    let names = head.lower_names();
    let is_axis = |name: &String| is_axis(name);
    match FileFormat::of_text(&head) {
        Ok(FileFormat::Csv) if head.first_row.is_none() => names.iter().any(is_axis),
        // names in a comment, which the plain reader does not see
        Ok(FileFormat::Csv) => names.is_empty() || names.iter().skip(1).take(3).all(is_axis),
        Ok(FileFormat::ImuTk) => true,
        _ => false,
    }
}
