//! Calibrations on data that were not used for them: `--validate`, `--folds`.

use super::Arguments;
use super::accelerometer::{Done, Job};
use crate::console;
use crate::recording_options::{in_file, name, spikes_taken_out, take_out_spikes};
use calibrant::Error;
use calibrant::error::InputError;
use calibrant::estimate::{
    CalibrationSettings, HoldCalibration, HoldsSetup, ImuCalibration, ImuProblem, ImuSetup, Recovered,
    Stimulus, Validation, ValidationSource, cross_validate, cross_validate_imu, noise_in_common,
    other_temperature, readings_in_common, validate, validate_imu,
};
use calibrant::io::{ImuFile, ImuReadOptions, read_accelerometer, read_imu_pair, read_imu_recording};
use calibrant::motion::Hold;
use calibrant::report::message;
use calibrant::sensor::{Recording, SensorKind, Temperatures};
use std::path::Path;

/// Refuses `--validate` and `--folds` with several recordings.
pub(super) fn only_one(arguments: &Arguments) -> calibrant::Result<()> {
    if arguments.validate.is_none() && arguments.folds.is_none() {
        return Ok(());
    }
    Err(Error::Experiment(Box::new(InputError::new(
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

/// Reads the recording of an IMU that a calibration is tried on; where it lacks its gyroscope, the option that gives it is named.
fn read_other(arguments: &Arguments, path: &Path, options: &ImuReadOptions) -> calibrant::Result<ImuFile> {
    let gyroscope = arguments.validate_gyroscope.as_deref();
    let help = "give the gyroscope's file of that recording with --validate-gyroscope";
    match read(path, gyroscope, options) {
        Ok(file) if gyroscope.is_none() && file.recording.gyroscope.is_none() => {
            let message = "the recording has no gyroscope";
            Err(Error::Recording(Box::new(InputError::new(message, help).in_file(path))))
        }
        Err(Error::Recording(input_error))
            if gyroscope.is_none() && input_error.help.contains("with --gyroscope,") =>
        {
            Err(Error::Recording(Box::new(InputError { help: help.into(), ..*input_error })))
        }
        read => read,
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
        let mut other = read_other(arguments, path, options)?;
        let second = arguments.validate_gyroscope.as_deref().map(name);
        console::findings(&other.findings, &name(path), second.as_deref());
        let spikes = take_out_spikes(&mut other.recording);
        spikes.iter().for_each(|found| console::warn(&format!("{}: {}", name(path), message(found))));
        let gyroscope_path = arguments.validate_gyroscope.as_deref().unwrap_or(path);
        for (sensor_kind, path) in
            [(SensorKind::Accelerometer, path.as_path()), (SensorKind::Gyroscope, gyroscope_path)]
        {
            let known = (&*file.sha256.concat(), file.recording.sensor(sensor_kind));
            let others = (&*other.sha256.concat(), other.recording.sensor(sensor_kind));
            refuse_the_same(sensor_kind, known, &calibration.holds, others, path)?;
        }
        let (holds, latitude_deg) = (found(&problem.setup.holds), problem.setup.latitude_deg);
        let setup = ImuSetup { holds, latitude_deg, ..ImuSetup::default() };
        let on_other = ImuProblem { recording: &other.recording, setup: &setup, ..*problem };
        let mut validation = validate_imu(calibration, &on_other).map_err(|error| in_file(error, path))?;
        let temperature = other_temperature(calibration, &validation, problem.recording, &other.recording);
        validation.reasons.extend(temperature);
        let thermal = &calibration.imu.thermal;
        let range = Temperatures::of(&other.recording)?.and_then(|temperatures| temperatures.range_c());
        if let Some(words) = range.and_then(|range| console::beyond(thermal, range)) {
            console::warn(&format!("{}: {words}", name(path)));
        }
        validations.push(on(path, validation));
    }
    if let Some(folds) = arguments.folds {
        let settings = CalibrationSettings::default();
        validations.extend(unless_too_few(cross_validate_imu(calibration, problem, &settings, folds))?);
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
        let mut other = read_accelerometer(path, &job.read, &job.device)?;
        other.findings.iter().for_each(|finding| console::finding(&name(path), finding));
        let spikes = job.holds.as_ref().and_then(|_| spikes_taken_out(&mut other.recording));
        spikes.iter().for_each(|found| console::warn(&format!("{}: {}", name(path), message(found))));
        if let Recovered::Holds(holds) = &done.calibration.recovered {
            refuse_the_same(
                SensorKind::Accelerometer,
                (&done.input.sha256, Some(&done.file.recording)),
                holds,
                (&other.sha256, Some(&other.recording)),
                path,
            )?;
        }
        let setup = job.holds.as_ref().map(found);
        let mut problem = job.problem(&other.recording);
        if let Some(setup) = &setup {
            problem.stimulus = Stimulus::Holds(setup);
        }
        let validation = validate(&done.calibration, &problem).map_err(|error| in_file(error, path))?;
        validations.push(on(path, validation));
    }
    if let Some(folds) = arguments.folds {
        validations.extend(unless_too_few(cross_validate(
            &done.calibration,
            &problem,
            &job.settings,
            folds,
        ))?);
    }
    Ok(validations)
}

/// What folds say; a recording whose holds do not suffice for them is calibrated still.
fn unless_too_few(folds: calibrant::Result<Validation>) -> calibrant::Result<Option<Validation>> {
    match folds {
        Err(error @ Error::Recording(_)) => {
            console::warn(&format!("not validated by folds: {error}"));
            Ok(None)
        }
        folds => folds.map(Some),
    }
}

/// The holds of another recording are found: intervals that are given are those of the first.
fn found(setup: &HoldsSetup) -> HoldsSetup {
    HoldsSetup { intervals_s: None, ..setup.clone() }
}

fn on(path: &Path, validation: Validation) -> Validation {
    Validation { source: ValidationSource::Recording { name: name(path) }, ..validation }
}

/// Refuses the data of a sensor that were calibrated from: the same file, its readings in another file, whole or cut, in another order, or the recording in disguise.
fn refuse_the_same(
    sensor_kind: SensorKind,
    (one_hash, one): (&str, Option<&Recording>),
    holds: &HoldCalibration,
    (other_hash, other): (&str, Option<&Recording>),
    path: &Path,
) -> calibrant::Result<()> {
    let refused = |what: &str| {
        let message = format!("{what}; errors on them are smaller than on other data, and validate nothing");
        let help = "give another recording of the sensor, or --folds 5 in place of --validate: blocks of holds, each predicted from the others";
        Err(Error::Experiment(Box::new(InputError::new(message, help).in_file(path))))
    };
    let same = match sensor_kind {
        SensorKind::Accelerometer => "it has the data that were calibrated from",
        SensorKind::Gyroscope => "its gyroscope has the data that were calibrated from",
    };
    if one_hash == other_hash {
        return refused(same);
    }
    let Some((one, other)) = one.zip(other) else { return Ok(()) };
    let (long, short) = if one.len() < other.len() { (other, one) } else { (one, other) };
    if long.readings.windows(short.len().max(1)).any(|segment| segment == short.readings) {
        return refused(same);
    }
    let holds: Vec<Hold> = holds.holds.iter().map(|result| result.hold.clone()).collect();
    let (in_common, correlation) =
        rayon::join(|| readings_in_common(one, &holds, other), || noise_in_common(one, &holds, other));
    if let Some(share) = in_common {
        let percent = (100.0 * share).floor();
        return refused(&format!(
            "{same}, in another order (reversed, its parts exchanged?): {percent} % of the readings in holds are in it to the last digit"
        ));
    }
    match correlation {
        Some(correlation) => refused(&format!(
            "{same}, in another form (rounded, smoothed, thinned out, in other units?): the noise of its samples is theirs (correlation {correlation:.2}, where another recording has none)"
        )),
        None => Ok(()),
    }
}
