//! `calibrant calibrate` for a whole IMU.

use super::Arguments;
use super::imu_noise::{HoldNoise, LongestHold};
use crate::reading::{in_file, name};
use crate::{Exit, console};
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::estimate::{CalibrationSettings, ImuProblem, ImuSetup, Turn, calibrate_imu, find_imu_holds};
use calibrant::io::{
    Experiment, HoldsPlan, ImuFile, ImuPlan, ImuReadOptions, ImuUnit, Input, Plan, Section, SectionKind,
    read_sections,
};
use calibrant::sensor::{ReadingUnit, Triad};

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
    let file = super::validation::read(path, arguments.gyroscope.as_deref(), &options)?;
    for finding in &file.findings {
        console::finding(&name(path), finding);
    }
    let mut setup = setup(arguments, plan, holds, &file)?;
    if setup.holds.intervals_s.is_none() {
        // an error is the calibration's to tell
        setup.found = find_imu_holds(&file.recording, setup.holds.minimum_hold_s).ok();
    }
    let longest = LongestHold::of(&setup, &file.recording);
    let noise =
        |triad: Triad, other: Option<&HoldNoise>| longest.as_ref()?.noise(triad, &file.recording, other);
    let of_gyroscope = noise(Triad::Gyroscope, None);
    setup.white_noise =
        longest.as_ref().zip(of_gyroscope.as_ref()).and_then(|(hold, noise)| hold.white_noise(noise));
    let problem = ImuProblem {
        accelerometer: &experiment.sensor,
        gyroscope: &plan.gyroscope,
        recording: &file.recording,
        setup: &setup,
    };
    let (calibration, of_accelerometer) = rayon::join(
        || calibrate_imu(&problem, &CalibrationSettings::default()).map_err(|error| in_file(error, path)),
        // for the report alone
        || if arguments.no_report { None } else { noise(Triad::Accelerometer, of_gyroscope.as_ref()) },
    );
    let mut calibration = calibration?;
    calibration.validations = super::validation::of_imu(arguments, &options, &calibration, &problem, &file)?;
    let main = file.recording.accelerometer.as_ref();
    let input = Input {
        file: arguments
            .gyroscope
            .as_ref()
            .map_or_else(|| name(path), |second| format!("{} and {}", name(path), name(second))),
        sha256: file.sha256.clone(),
        samples: main.map_or(0, calibrant::sensor::Recording::len),
        rate_hz: main.map_or(0.0, calibrant::sensor::Recording::rate_hz),
    };
    let noise: Vec<HoldNoise> = of_accelerometer.into_iter().chain(of_gyroscope).collect();
    super::imu_output::write(arguments, &calibration, &file, noise, &input)?;
    for warning in &calibration.warnings {
        console::warn(warning);
    }
    super::imu_output::show(arguments, &calibration, &input);
    Ok(Exit::of_status(calibration.status))
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
