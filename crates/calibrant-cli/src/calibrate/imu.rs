//! `calibrant calibrate` for a whole IMU.

use super::Arguments;
use super::imu_noise::LongestHold;
use crate::reading::{in_file, name};
use crate::{Exit, console};
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::estimate::{
    CalibrationSettings, ImuProblem, ImuSetup, Turn, calibrate_imu_while, find_imu_holds,
};
use calibrant::io::{
    Experiment, HoldsPlan, ImuFile, ImuPlan, ImuReadOptions, ImuUnit, Input, Plan, Section, SectionKind,
    read_sections,
};
use calibrant::noise::TriadNoise;
use calibrant::sensor::{ReadingUnit, Recording, Triad};
use std::path::Path;

pub(super) fn run(arguments: &Arguments, experiment: &Experiment, plan: &ImuPlan) -> calibrant::Result<Exit> {
    let Plan::Holds(holds) = &experiment.plan else {
        return Err(Error::Experiment(Box::new(Complaint::new(
            "an IMU needs [holds]",
            "see `calibrant init imu`",
        ))));
    };
    let [path] = arguments.recordings.as_slice() else {
        return Err(Error::Experiment(Box::new(Complaint::new(
            "an IMU is calibrated from one recording at a time",
            "where the gyroscope has a file of its own, give it with --gyroscope FILE",
        ))));
    };
    if arguments.unit.is_some() {
        console::warn("--unit is not used for an IMU: say --accelerometer-unit and --gyroscope-unit");
    }
    if arguments.motion.is_some() {
        console::warn("--motion is not used: an IMU is calibrated from holds and what lies between them");
    }
    let options = options(arguments, experiment, plan);
    let read =
        |options: &ImuReadOptions| super::validation::read(path, arguments.gyroscope.as_deref(), options);
    let file = read(&options)
        .map_err(|error| contradicted_key(arguments, experiment, &options, read).unwrap_or(error))?;
    for finding in &file.findings {
        console::finding(&name(path), finding);
    }
    let mut setup = setup(arguments, plan, holds, &file)?;
    if setup.holds.intervals_s.is_none() {
        // an error is the calibration's to tell
        setup.found = find_imu_holds(&file.recording, setup.holds.minimum_hold_s).ok();
    }
    let (accelerometer, gyroscope, recording) = (&experiment.sensor, &plan.gyroscope, &file.recording);
    let problem = ImuProblem { accelerometer, gyroscope, recording, setup: &setup };
    let longest = LongestHold::of(&setup, &file.recording);
    let noise = |triad: Triad| longest.as_ref()?.noise(triad, recording);
    let (mut of_gyroscope, mut white_noise) = (None, None);
    let find_white_noise = || {
        of_gyroscope = noise(Triad::Gyroscope);
        white_noise = longest.as_ref()?.white_noise(of_gyroscope.as_ref()?);
        white_noise
    };
    let (calibration, (inputs, of_accelerometer)) = rayon::join(
        || calibrate_imu_while(&problem, &CalibrationSettings::default(), find_white_noise),
        || {
            let for_report = !arguments.no_report;
            (inputs(arguments, path, &file), for_report.then(|| noise(Triad::Accelerometer)).flatten())
        },
    );
    let mut calibration = calibration.map_err(|error| in_file(error, path))?;
    calibration.warnings.extend(of_gyroscope.iter().flat_map(TriadNoise::of_outliers));
    setup.white_noise = white_noise;
    let problem = ImuProblem { accelerometer, gyroscope, recording, setup: &setup };
    calibration.validations = super::validation::of_imu(arguments, &options, &calibration, &problem, &file)?;
    let noise: Vec<TriadNoise> = of_accelerometer.into_iter().chain(of_gyroscope).collect();
    super::imu_output::write(arguments, &calibration, &file, noise, &inputs)?;
    for warning in &calibration.warnings {
        console::warn(warning);
    }
    super::imu_output::show(arguments, &calibration, &inputs);
    Ok(Exit::of_status(calibration.status))
}

/// The files, for calibration.json.
fn inputs(arguments: &Arguments, path: &Path, file: &ImuFile) -> Vec<Input> {
    let paths = std::iter::once(path).chain(arguments.gyroscope.as_deref());
    paths
        .zip(Triad::ALL)
        .zip(&file.sha256)
        .map(|((path, triad), sha256)| {
            let readings = file.recording.triad(triad);
            Input {
                file: name(path),
                sha256: sha256.clone(),
                samples: readings.map_or(0, Recording::len),
                rate_hz: readings.map_or(0.0, Recording::rate_hz),
            }
        })
        .collect()
}

/// What the user says of the file: the command line first, then `[columns]`, then the units of the sensors.
fn options(arguments: &Arguments, experiment: &Experiment, plan: &ImuPlan) -> ImuReadOptions {
    let sensors = ImuReadOptions {
        accelerometer_unit: (experiment.sensor.unit == ReadingUnit::Counts).then_some(ImuUnit::Counts),
        gyroscope_unit: plan.file_unit,
        ..ImuReadOptions::default()
    };
    arguments.reading.options().or(experiment.columns.clone()).or(sensors)
}

/// The complaint of a unit that the experiment file says and the recording contradicts, where that is why the recording cannot be read.
fn contradicted_key(
    arguments: &Arguments,
    experiment: &Experiment,
    options: &ImuReadOptions,
    read: impl Fn(&ImuReadOptions) -> calibrant::Result<ImuFile>,
) -> Option<Error> {
    let by_option = arguments.reading.options();
    let of_experiment = |triad: &Triad| by_option.unit(*triad).is_none() && options.unit(*triad).is_some();
    Triad::ALL.into_iter().filter(of_experiment).find_map(|triad| {
        // it can be read without that unit only if it states another
        read(&options.clone().with_unit(triad, None)).ok()?;
        let key = match (experiment.columns.unit(triad), triad) {
            (Some(_), _) => format!("columns.{triad}_unit"),
            (None, Triad::Accelerometer) => "sensor.unit".into(),
            (None, Triad::Gyroscope) => "gyroscope.unit".into(),
        };
        let message = format!(
            "`{key}` is {}, but the recording states another unit of the {triad}",
            options.unit(triad)?.symbol()
        );
        let help = "correct it, or name the columns in [columns] to overrule the file; `calibrant inspect` says what it states";
        Some(Error::Experiment(Box::new(Complaint::new(message, help).in_file(&arguments.experiment))))
    })
}

fn setup(
    arguments: &Arguments,
    plan: &ImuPlan,
    holds: &HoldsPlan,
    file: &ImuFile,
) -> calibrant::Result<ImuSetup> {
    let mut setup = plan.setup(holds);
    if let Some(path) = &arguments.sections {
        let times = file.recording.accelerometer.as_ref().map_or(&[][..], |recording| &recording.times_s);
        let sections = read_sections(path)?;
        if let Some(late) = sections.iter().find(|section| section.end > times.len()) {
            let message = format!("a section ends at sample {}, the recording at {}", late.end, times.len());
            let complaint = Complaint::new(message, "are the list and the recording of one session?");
            return Err(Error::Experiment(Box::new(complaint.in_file(path))));
        }
        take_sections(&mut setup, &sections, times, plan);
    }
    Ok(setup)
}

/// Faces and turns from a list of sections.
fn take_sections(setup: &mut ImuSetup, sections: &[Section], times: &[f64], plan: &ImuPlan) {
    let (mut intervals, mut directions) = (Vec::new(), Vec::new());
    for section in sections {
        let (start_s, end_s) = (times[section.start], times[section.end - 1]);
        match section.kind {
            SectionKind::Face(direction) => {
                intervals.push((start_s, end_s));
                directions.push(direction);
            }
            SectionKind::Turn(axis) => setup.turns.push(Turn {
                start_s,
                end_s,
                axis,
                angle_rad: plan.section_angle_rad,
                angle_sd_rad: plan.section_angle_sd_rad,
            }),
        }
    }
    setup.holds.intervals_s = Some(intervals);
    setup.directions = Some(directions);
}
