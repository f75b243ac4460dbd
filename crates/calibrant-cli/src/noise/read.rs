//! The recording, whatever its format.

use crate::reading::name;
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::io::{
    Finding, FindingKind, ImuReadOptions, Input, ReadOptions, read_imu_recording, read_recording,
};
use calibrant::sensor::{ImuRecording, ReadingUnit, Recording, Triad};
use std::path::Path;

/// The recording of one sensor, and of the other too where the file has it.
pub(super) struct File {
    pub(super) imu: ImuRecording,
    pub(super) findings: Vec<Finding>,
    pub(super) input: Input,
    /// Has the file columns that were not read?
    leaves_columns_aside: bool,
}

/// Reads the recording of a sensor, from a file of its own or from one of a whole IMU.
pub(super) fn read(
    path: &Path,
    triad: Triad,
    unit: Option<ReadingUnit>,
    counts: bool,
    options: &ImuReadOptions,
) -> calibrant::Result<File> {
    // a gyroscope's columns come first by name: a file of one sensor calls any of them ax, ay, az
    match triad {
        Triad::Accelerometer => match alone(path, triad, unit, counts) {
            Ok(mut file) => {
                // holds are those of both sensors
                file.imu.gyroscope =
                    read_imu_recording(path, options).ok().and_then(|whole| whole.recording.gyroscope);
                Ok(file)
            }
            Err(_) => of_imu(path, triad, options),
        },
        Triad::Gyroscope => of_imu(path, triad, options).or_else(|error| {
            alone(path, triad, unit, counts).ok().filter(|file| may_be_alone(file, triad)).ok_or(error)
        }),
    }
}

/// Is a file whose columns are called ax, ay, az one of another sensor alone? Not where these are accelerations, or there are other columns beside them.
fn may_be_alone(file: &File, triad: Triad) -> bool {
    let in_counts_or_its_own =
        |recording: &Recording| [ReadingUnit::Counts, triad.stimulus_unit()].contains(&recording.unit);
    !file.leaves_columns_aside && file.imu.triad(triad).is_some_and(in_counts_or_its_own)
}

fn of_imu(path: &Path, triad: Triad, options: &ImuReadOptions) -> calibrant::Result<File> {
    let file = read_imu_recording(path, options)?;
    let imu = file.recording;
    let Some(recording) = imu.triad(triad) else {
        let complaint = Complaint::new(format!("the file has no {triad}"), "choose the other with --sensor");
        return Err(Error::Recording(Box::new(complaint.in_file(path))));
    };
    let input = input(path, file.sha256.concat(), recording);
    Ok(File { input, findings: file.findings, imu, leaves_columns_aside: false })
}

fn input(path: &Path, sha256: String, recording: &Recording) -> Input {
    Input { file: name(path), sha256, samples: recording.len(), rate_hz: recording.rate_hz() }
}

fn alone(path: &Path, triad: Triad, unit: Option<ReadingUnit>, counts: bool) -> calibrant::Result<File> {
    // a gain makes sense for counts only
    let expected_unit = if counts { ReadingUnit::Counts } else { triad.stimulus_unit() };
    let file = read_recording(path, &ReadOptions { unit, expected_unit, axes: 3 })?;
    let input = input(path, file.sha256, &file.recording);
    let mut imu = ImuRecording::default();
    match triad {
        Triad::Accelerometer => imu.accelerometer = Some(file.recording),
        Triad::Gyroscope => imu.gyroscope = Some(file.recording),
    }
    let leaves_columns_aside =
        file.findings.iter().any(|finding| finding.kind == FindingKind::IgnoredColumns);
    Ok(File { imu, findings: file.findings, input, leaves_columns_aside })
}
