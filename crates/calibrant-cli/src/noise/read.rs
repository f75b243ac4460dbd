//! The recording, whatever its format.

use calibrant::io::{Input, ReadOptions, read_recording};
use calibrant::sensor::{ImuRecording, ReadingUnit, Triad};
use std::path::Path;

/// A recording of one sensor or two.
pub(super) struct File {
    pub(super) imu: ImuRecording,
    pub(super) findings: Vec<String>,
    pub(super) input: Input,
}

/// Reads a recording of one sensor.
pub(super) fn read(
    path: &Path,
    triad: Triad,
    unit: Option<ReadingUnit>,
    counts: bool,
) -> calibrant::Result<File> {
    // a gain makes sense for counts only
    let expected_unit = if counts { ReadingUnit::Counts } else { triad.stimulus_unit() };
    let file = read_recording(path, &ReadOptions { unit, expected_unit, axes: 3 })?;
    let input = Input {
        file: path
            .file_name()
            .map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned()),
        sha256: file.sha256,
        samples: file.recording.len(),
        rate_hz: file.recording.rate_hz(),
    };
    let mut imu = ImuRecording::default();
    match triad {
        Triad::Accelerometer => imu.accelerometer = Some(file.recording),
        Triad::Gyroscope => imu.gyroscope = Some(file.recording),
    }
    Ok(File { imu, findings: file.findings.iter().map(ToString::to_string).collect(), input })
}
