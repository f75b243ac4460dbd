//! Calibrations on data that were not used for them: `--validate`, `--folds`.

use super::{Arguments, Done, Job};
use crate::console;
use crate::reading::{in_file, name};
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::estimate::{
    CalibrationSettings, HoldsSetup, ImuCalibration, ImuProblem, ImuSetup, Stimulus, Validation,
    ValidationSource, cross_validate, cross_validate_imu, validate, validate_imu,
};
use calibrant::io::{ImuFile, ImuReadOptions, read_accelerometer, read_imu_pair, read_imu_recording};
use calibrant::sensor::Recording;
use std::path::Path;

/// Refuses `--validate` and `--folds` with several recordings.
pub(super) fn only_one(arguments: &Arguments) -> calibrant::Result<()> {
    if arguments.validate.is_none() && arguments.folds.is_none() {
        return Ok(());
    }
    Err(Error::Experiment(Box::new(Complaint::new(
        "one calibration is validated at a time, and several recordings are given",
        "give one recording with --validate or --folds",
    ))))
}

/// Reads the recording of an IMU from its file or its two files.
pub(super) fn read(
    path: &Path,
    gyroscope: Option<&Path>,
    options: &ImuReadOptions,
) -> calibrant::Result<ImuFile> {
    match gyroscope {
        Some(gyroscope) => read_imu_pair(path, gyroscope, options),
        None => read_imu_recording(path, options),
    }
}

/// What was asked for of an IMU.
pub(super) fn of_imu(
    arguments: &Arguments,
    options: &ImuReadOptions,
    calibration: &ImuCalibration,
    problem: &ImuProblem<'_>,
    file: &ImuFile,
) -> calibrant::Result<Vec<Validation>> {
    let mut validations = Vec::new();
    if let Some(path) = &arguments.validate {
        let other = read(path, arguments.validate_gyroscope.as_deref(), options)?;
        other.findings.iter().for_each(|finding| console::finding(&name(path), finding));
        refuse_the_same(
            (&file.sha256.concat(), file.recording.accelerometer.as_ref()),
            (&other.sha256.concat(), other.recording.accelerometer.as_ref()),
            path,
        )?;
        let setup = ImuSetup { holds: found(&problem.setup.holds), ..ImuSetup::default() };
        let problem = ImuProblem { recording: &other.recording, setup: &setup, ..*problem };
        let validation = validate_imu(calibration, &problem).map_err(|error| in_file(error, path))?;
        validations.push(on(path, validation));
    }
    if let Some(folds) = arguments.folds {
        let settings = CalibrationSettings::default();
        validations.push(cross_validate_imu(calibration, problem, &settings, folds)?);
    }
    Ok(validations)
}

/// What was asked for of an accelerometer.
pub(super) fn of_accelerometer(
    job: &Job,
    arguments: &Arguments,
    done: &Done,
) -> calibrant::Result<Vec<Validation>> {
    let problem = job.problem(&done.file.recording);
    let mut validations = Vec::new();
    if let Some(path) = &arguments.validate {
        let other = read_accelerometer(path, &job.read, &job.device)?;
        other.findings.iter().for_each(|finding| console::finding(&name(path), finding));
        refuse_the_same(
            (&done.input.sha256, Some(&done.file.recording)),
            (&other.sha256, Some(&other.recording)),
            path,
        )?;
        let setup = job.holds.as_ref().map(found);
        let mut problem = job.problem(&other.recording);
        if let Some(setup) = &setup {
            problem.stimulus = Stimulus::Holds(setup);
        }
        let validation = validate(&done.calibration, &problem).map_err(|error| in_file(error, path))?;
        validations.push(on(path, validation));
    }
    if let Some(folds) = arguments.folds {
        validations.push(cross_validate(&done.calibration, &problem, &job.settings, folds)?);
    }
    Ok(validations)
}

/// The holds of another recording are found: intervals that are given are those of the first.
fn found(setup: &HoldsSetup) -> HoldsSetup {
    HoldsSetup { intervals_s: None, ..setup.clone() }
}

fn on(path: &Path, validation: Validation) -> Validation {
    Validation { source: ValidationSource::Recording { name: name(path) }, ..validation }
}

/// Refuses the data that were calibrated from: the same file, or its readings in another file, whole or cut.
fn refuse_the_same(
    (one_hash, one): (&str, Option<&Recording>),
    (other_hash, other): (&str, Option<&Recording>),
    path: &Path,
) -> calibrant::Result<()> {
    let contained = one.zip(other).is_some_and(|(one, other)| {
        let (long, short) = if one.len() < other.len() { (other, one) } else { (one, other) };
        long.readings.windows(short.len().max(1)).any(|stretch| stretch == short.readings)
    });
    if one_hash != other_hash && !contained {
        return Ok(());
    }
    let message = "it has the data that were calibrated from: their errors are smaller than those on other data, and validate nothing";
    let help = "give another recording of the sensor, or --folds 5 in place of --validate: blocks of holds, each predicted from the others";
    Err(Error::Experiment(Box::new(Complaint::new(message, help).in_file(path))))
}
