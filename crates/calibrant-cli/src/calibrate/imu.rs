//! `calibrant calibrate` for a whole IMU.

use super::Arguments;
use super::batch::{Calibrated, Outcome};
use super::imu_noise::LongestHold;
use super::imu_output::Done;
use crate::recording_options::{in_file, name, take_out_spikes};
use crate::{Exit, console};
use calibrant::Error;
use calibrant::error::InputError;
use calibrant::estimate::{
    CalibrationSettings, ImuProblem, ImuSetup, Turn, calibrate_imu_while, find_clean_imu_holds,
};
use calibrant::io::{
    Experiment, HoldsPlan, ImuFile, ImuPlan, ImuReadOptions, ImuUnit, Input, Plan, Section, SectionKind,
    Summary, imu_calibration_json, read_sections,
};
use calibrant::noise::SensorNoise;
use calibrant::report::number_format;
use calibrant::sensor::{ReadingUnit, Recording, SensorKind};
use std::path::{Path, PathBuf};

/// What all recordings of a call share.
struct Job<'a> {
    arguments: &'a Arguments,
    experiment: &'a Experiment,
    plan: &'a ImuPlan,
    holds: &'a HoldsPlan,
    options: ImuReadOptions,
}

/// A recording: one file for both sensors, or one for each.
#[derive(Clone, Copy)]
struct Files<'a> {
    path: &'a Path,
    gyroscope: Option<&'a Path>,
}

pub(super) fn run(arguments: &Arguments, experiment: &Experiment, plan: &ImuPlan) -> calibrant::Result<Exit> {
    let Plan::Holds(holds) = &experiment.plan else {
        return refuse("an IMU needs [holds]", "see `calibrant init imu`");
    };
    if arguments.unit.is_some() {
        console::warn("--unit is not used for an IMU: say --accelerometer-unit and --gyroscope-unit");
    }
    if arguments.motion.is_some() {
        console::warn("--motion is not used: an IMU is calibrated from holds and what lies between them");
    }
    let job = Job { arguments, experiment, plan, holds, options: options(arguments, experiment, plan) };
    let recordings = recordings(arguments)?;
    if let [files] = recordings.as_slice() {
        let done = job.read(*files).and_then(|file| {
            console::findings(&file.findings, &name(files.path), files.gyroscope.map(name).as_deref());
            job.calibrate(*files, file, &arguments.output)
        });
        let done = done.inspect_err(|_| super::earlier::warn_of_earlier_result(&arguments.output))?;
        let exit = arguments.rules.show(&done.calibration.warnings, "");
        super::imu_output::show(arguments, &done);
        return Ok(exit.max(Exit::of_status(done.calibration.status)));
    }
    super::validation::only_one(arguments)?;
    if arguments.sections.is_some() {
        return refuse(
            "--sections is the list of one recording, and several are given",
            "calibrate one recording at a time with its list",
        );
    }
    let columns = ["holds used", "rotations used", "|f|−g mm/s²", "gravity error °"];
    super::batch::run(arguments, &columns, |number, directory| job.one_of_many(recordings[number], directory))
}

fn refuse<T>(what: &str, help: &str) -> calibrant::Result<T> {
    Err(Error::Experiment(Box::new(InputError::new(what, help))))
}

/// The recordings with their gyroscopes' files.
fn recordings(arguments: &Arguments) -> calibrant::Result<Vec<Files<'_>>> {
    let (recordings, gyroscopes) = (&arguments.recordings, &arguments.gyroscope);
    if !gyroscopes.is_empty() && gyroscopes.len() != recordings.len() {
        return refuse(
            &format!(
                "{} of gyroscopes for {}",
                number_format::counted(gyroscopes.len(), "file"),
                number_format::counted(recordings.len(), "recording")
            ),
            "give --gyroscope FILE once for each recording, in their order, or not at all where the recordings have both sensors",
        );
    }
    let gyroscope = |number: usize| gyroscopes.get(number).map(PathBuf::as_path);
    Ok(recordings.iter().enumerate().map(|(k, path)| Files { path, gyroscope: gyroscope(k) }).collect())
}

impl Job<'_> {
    fn read(&self, files: Files<'_>) -> calibrant::Result<ImuFile> {
        let read = |options: &ImuReadOptions| super::validation::read(files.path, files.gyroscope, options);
        read(&self.options).map_err(|error| {
            contradicted_key(self.arguments, self.experiment, &self.options, read).unwrap_or(error)
        })
    }

    /// Calibrates the IMU and writes what came of it.
    fn calibrate(&self, files: Files<'_>, mut file: ImuFile, directory: &Path) -> calibrant::Result<Done> {
        let Self { arguments, experiment, plan, holds, options } = self;
        let mut setup = setup(arguments, plan, holds, &file)?;
        // once for all that follows: holds, noise, validation, report
        let spikes = take_out_spikes(&mut file.recording);
        if setup.holds.intervals_s.is_none() {
            // an error is the calibration's to tell
            setup.found = find_clean_imu_holds(&file.recording, setup.holds.minimum_hold_s).ok();
        }
        let (accelerometer, gyroscope, recording) = (&experiment.sensor, &plan.gyroscope, &file.recording);
        let problem = ImuProblem { accelerometer, gyroscope, recording, setup: &setup };
        let longest = LongestHold::of(&setup, &file.recording);
        let noise = &|sensor_kind: SensorKind| longest.as_ref()?.noise(sensor_kind, recording);
        let (mut of_accelerometer, mut of_gyroscope, mut white_noise) = (None, None, None);
        let only_for_report = (!arguments.no_report).then_some(&mut of_accelerometer);
        let calibration = rayon::scope(|scope| {
            let find_white_noise = || {
                of_gyroscope = noise(SensorKind::Gyroscope);
                // beside the fit of the rotations, which leaves a processor idle at times
                if let Some(found) = only_for_report {
                    scope.spawn(move |_| *found = noise(SensorKind::Accelerometer));
                }
                white_noise = longest.as_ref()?.white_noise(of_gyroscope.as_ref()?);
                white_noise
            };
            calibrate_imu_while(&problem, &CalibrationSettings::default(), find_white_noise)
        });
        let mut calibration = calibration.map_err(|error| in_file(error, files.path))?;
        let inputs = files.inputs(&file);
        calibration.warnings.splice(0..0, spikes);
        calibration.warnings.extend(of_gyroscope.iter().flat_map(SensorNoise::of_outliers));
        setup.white_noise = white_noise;
        let problem = ImuProblem { accelerometer, gyroscope, recording, setup: &setup };
        let validations = super::validation::of_imu(arguments, options, &calibration, &problem, &file)?;
        let noise: Vec<SensorNoise> = of_accelerometer.into_iter().chain(of_gyroscope).collect();
        let done = Done { calibration, validations, file, inputs };
        super::imu_output::write(arguments, directory, &done, noise)?;
        Ok(done)
    }

    fn one_of_many(&self, files: Files<'_>, directory: &Path) -> Outcome {
        let file = match self.read(files) {
            Ok(file) => file,
            Err(error) => return Outcome { findings: Vec::new(), calibrated: Err(error) },
        };
        let findings = file.findings.clone();
        Outcome {
            findings,
            calibrated: self.calibrate(files, file, directory).map(|done| self.reported(done)),
        }
    }

    fn reported(&self, Done { calibration, validations, inputs, .. }: Done) -> Calibrated {
        let words = self.arguments.rules.words();
        let json =
            self.arguments.json.then(|| imu_calibration_json(&calibration, &validations, &inputs, &words));
        let magnitude = calibration.holds.magnitude_residual_rms_mps2;
        let cells = vec![
            share(calibration.holds.holds.iter().map(|hold| hold.used)),
            share(calibration.rotations.iter().map(|rotation| rotation.used)),
            match calibration.holds.degrees_of_freedom {
                0 => "–".into(),
                _ => number_format::significant(1e3 * magnitude, 3),
            },
            match calibration.rotations.is_empty() {
                true => "–".into(),
                false => number_format::significant(calibration.rotation_rms_rad().to_degrees(), 2),
            },
        ];
        let (status, summary) = (calibration.status, Summary::of_imu(&calibration));
        Calibrated { status, warnings: calibration.warnings, cells, summary, json }
    }
}

/// How many of them are used, in words.
fn share(used: impl ExactSizeIterator<Item = bool>) -> String {
    match used.len() {
        0 => "–".into(),
        all => format!("{} of {all}", used.filter(|used| *used).count()),
    }
}

impl Files<'_> {
    /// What calibration.json says of them.
    fn inputs(self, file: &ImuFile) -> Vec<Input> {
        let paths = std::iter::once(self.path).chain(self.gyroscope);
        let input = |((path, sensor_kind), sha256): ((&Path, SensorKind), &String)| {
            let readings = file.recording.sensor(sensor_kind);
            Input {
                file: name(path),
                sha256: sha256.clone(),
                samples: readings.map_or(0, Recording::len),
                rate_hz: readings.map_or(0.0, Recording::rate_hz),
            }
        };
        paths.zip(SensorKind::ALL).zip(&file.sha256).map(input).collect()
    }
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
    let of_experiment = |sensor_kind: &SensorKind| {
        by_option.unit(*sensor_kind).is_none() && options.unit(*sensor_kind).is_some()
    };
    SensorKind::ALL.into_iter().filter(of_experiment).find_map(|sensor_kind| {
        // it can be read without that unit only if it states another
        read(&options.clone().with_unit(sensor_kind, None)).ok()?;
        let key = match (experiment.columns.unit(sensor_kind), sensor_kind) {
            (Some(_), _) => format!("columns.{sensor_kind}_unit"),
            (None, SensorKind::Accelerometer) => "sensor.unit".into(),
            (None, SensorKind::Gyroscope) => "gyroscope.unit".into(),
        };
        let message = format!(
            "`{key}` is {}, but the recording states another unit of the {sensor_kind}",
            options.unit(sensor_kind)?.symbol()
        );
        let help = "correct it, or name the columns in [columns] to overrule the file; `calibrant inspect` says what it states";
        Some(Error::Experiment(Box::new(InputError::new(message, help).in_file(&arguments.experiment))))
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
            let input_error = InputError::new(message, "are the list and the recording of one session?");
            return Err(Error::Experiment(Box::new(input_error.in_file(path))));
        }
        if setup.holds.intervals_s.is_some() {
            console::warn(
                "holds.intervals_s and holds.directions are not used: the list of sections gives the faces",
            );
        }
        take_sections(&mut setup, &sections, times, plan);
    }
    if setup.face_sd_rad.is_some() && setup.directions.is_none() {
        console::warn("holds.face_sd_deg is not used: no directions of the holds are given");
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
                name: Some(section.name.clone()),
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
