//! `calibrant calibrate`: from recordings to parameters with their covariance.

mod imu;
mod imu_noise;
mod imu_output;
mod many;
mod validation;

use crate::place::same_file;
use crate::reading::{RecordingOptions, in_file, name, sparks_taken_out};
use crate::{Exit, console, place};
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, HoldsSetup, Recovered, Stimulus, Validation,
    calibrate,
};
use calibrant::io::{
    Experiment, ImuReadOptions, Input, Plan, Prior, ReadOptions, RecordingFile, Summary, calibration_json,
    read_accelerometer, read_motion, write_atomically, write_calibration,
};
use calibrant::motion::CommandedMotion;
use calibrant::report::{About, calibration_report, number};
use calibrant::sensor::{ReadingUnit, Recording};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Calibrate sensors from their recordings.
///
/// Writes calibration.json and report.html into DIR; with several recordings into a subfolder of DIR for each, named after its file, and
/// DIR/summary.csv. One bad recording does not stop the others; the exit status is then the highest of all.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file (see `calibrant init`).
    experiment: PathBuf,
    /// Recordings: CSV with header t_s,ax,ay,az, text with columns t x y z, or any file that `calibrant inspect` reads.
    #[arg(required = true)]
    recordings: Vec<PathBuf>,
    /// The commanded motion (nodes: t_s,ax_mps2,ay_mps2,az_mps2); a [holds] experiment needs none.
    #[arg(long, value_name = "CSV")]
    motion: Option<PathBuf>,
    /// The gyroscope's file, where an IMU's sensors have a file each (imu_tk); with several recordings once for each, in their order.
    #[arg(long, value_name = "FILE")]
    gyroscope: Vec<PathBuf>,
    /// List of the sections of a Ferraris session (JSON, as imucal writes it): faces and turns.
    #[arg(long, value_name = "JSON")]
    sections: Option<PathBuf>,
    /// Another recording of the sensor, to see whether the covariance is to be believed: errors on its holds and rotations beside what was predicted of them.
    #[arg(long, value_name = "FILE")]
    validate: Option<PathBuf>,
    /// The gyroscope's file of that recording, where it has one.
    #[arg(long, value_name = "FILE", requires = "validate")]
    validate_gyroscope: Option<PathBuf>,
    /// The same without another recording: leave out each of K blocks of the holds in turn, and predict it from the others.
    #[arg(long, value_name = "K")]
    folds: Option<usize>,
    #[command(flatten)]
    reading: RecordingOptions,
    /// Unit of the readings where the file does not say.
    #[arg(long, value_enum)]
    unit: Option<Unit>,
    /// Write no report.html: where there are many sensors, and time counts.
    #[arg(long)]
    no_report: bool,
    /// Print calibration.json on stdout in place of the tables; for several recordings an array with the file of each, and its calibration or its error.
    #[arg(long)]
    json: bool,
    /// Directory for the results.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// Names of the files that are written.
const RESULTS: [&str; 3] = ["calibration.json", "report.html", "summary.csv"];

/// A report that is not written anew is not that of the calibration beside it.
fn warn_of_earlier_report(directory: &Path) {
    warn_of_earlier(&directory.join("report.html"), "calibration: --no-report writes none");
}

/// What is left of an earlier run is not the result of one that failed.
fn warn_of_earlier_result(directory: &Path) {
    warn_of_earlier(&directory.join("calibration.json"), "recording: this one has none");
}

fn warn_of_earlier(file: &Path, what: &str) {
    if file.exists() {
        console::warn(&format!("{} is that of an earlier {what}", file.display()));
    }
}

impl Arguments {
    /// Refuses to write results of these folders of DIR where something was read.
    fn check_inputs(&self, folders: &[String]) -> calibrant::Result<()> {
        let others =
            [&self.motion, &self.sections, &self.validate, &self.validate_gyroscope].into_iter().flatten();
        let inputs = self.recordings.iter().chain(&self.gyroscope).chain([&self.experiment]).chain(others);
        for input in inputs {
            let is_taken = |name: &&OsStr| RESULTS.iter().any(|result| *name == *result);
            let Some(name) = input.file_name().filter(is_taken) else { continue };
            for folder in folders {
                place::check_not_input(&self.output.join(folder).join(name), &[input])?;
            }
        }
        Ok(())
    }

    /// The file to look at.
    fn main_result(&self) -> PathBuf {
        self.output.join(if self.no_report { "calibration.json" } else { "report.html" })
    }
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Unit {
    /// Metres per second squared.
    Mps2,
    /// Raw counts.
    Counts,
}

/// What all recordings of a call share.
struct Job {
    experiment: Experiment,
    experiment_file: PathBuf,
    command: Option<CommandedMotion>,
    holds: Option<HoldsSetup>,
    settings: CalibrationSettings,
    read: ReadOptions,
    device: ImuReadOptions,
    /// Is a report to be written?
    report: bool,
}

struct Done {
    file: RecordingFile,
    calibration: Calibration,
    validations: Vec<Validation>,
    input: Input,
}

pub(crate) fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    place::check_directory(&arguments.output)?;
    arguments.check_inputs(&[String::new()])?;
    let experiment = Experiment::read(&arguments.experiment)?;
    if let Some(plan) = &experiment.imu {
        return imu::run(arguments, &experiment, plan);
    }
    let job = Job::prepare(arguments, experiment)?;
    let [recording] = arguments.recordings.as_slice() else {
        validation::only_one(arguments)?;
        return many::run(arguments, &["p-value"], |number, directory| {
            job.one_of_many(&arguments.recordings[number], directory, arguments)
        });
    };
    let outcome = job.run(recording).and_then(|mut done| {
        done.validations = validation::of_accelerometer(&job, arguments, &done)?;
        job.write(&done, recording, &arguments.output)?;
        Ok(done)
    });
    match outcome {
        Ok(done) => {
            show(&done, arguments);
            Ok(Exit::of_status(done.calibration.status))
        }
        Err(error) => {
            warn_of_earlier_result(&arguments.output);
            console::error_in(&error, recording);
            Ok(Exit::of(&error))
        }
    }
}

impl Job {
    fn prepare(arguments: &Arguments, experiment: Experiment) -> calibrant::Result<Self> {
        if !arguments.gyroscope.is_empty() || arguments.sections.is_some() {
            console::warn("--gyroscope and --sections are not used: they are for kind = \"imu\"");
        }
        let (mut command, mut holds) = (None, None);
        match &experiment.plan {
            Plan::Motion(plan) => {
                let path = arguments.motion.as_deref().ok_or_else(|| {
                    Error::Experiment(Box::new(Complaint::new(
                        "a [motion] experiment needs the commanded motion",
                        "add --motion FILE with columns t_s,ax_mps2,ay_mps2,az_mps2 at the nodes; trust unknown uses only its first and last row",
                    )))
                })?;
                if let Some(recording) =
                    arguments.recordings.iter().find(|recording| same_file(recording, path))
                {
                    return Err(Error::Experiment(Box::new(Complaint::new(
                        format!("{} is both the motion and a recording", recording.display()),
                        "leave it out of the recordings, or keep them in a folder of their own",
                    ))));
                }
                let motion = read_motion(path, experiment.sensor.axes)?;
                if motion.intervals() != plan.intervals {
                    console::note(&format!(
                        "{} has {} intervals, the experiment file {}: the former counts",
                        path.display(),
                        motion.intervals(),
                        plan.intervals
                    ));
                }
                command = Some(CommandedMotion { motion, trust: plan.trust, known_ends: plan.known_ends });
            }
            Plan::Holds(plan) => {
                if arguments.motion.is_some() {
                    console::warn("--motion is not used: a [holds] experiment needs no motion");
                }
                holds = Some(HoldsSetup {
                    gravity: plan.gravity,
                    gauge: plan.gauge,
                    intervals_s: plan.intervals_s.clone(),
                    minimum_hold_s: plan.minimum_hold_s,
                });
            }
        }
        let settings = CalibrationSettings {
            datasheet_prior: experiment.calibrate.prior == Prior::Datasheet,
            ..CalibrationSettings::default()
        };
        let read = ReadOptions {
            unit: arguments.unit.map(|unit| match unit {
                Unit::Mps2 => ReadingUnit::MetrePerSecondSquared,
                Unit::Counts => ReadingUnit::Counts,
            }),
            expected_unit: experiment.sensor.unit,
            axes: experiment.sensor.axes,
        };
        let device = arguments.reading.options().or(experiment.columns.clone());
        let experiment_file = arguments.experiment.clone();
        let report = !arguments.no_report;
        Ok(Self { experiment, experiment_file, command, holds, settings, read, device, report })
    }

    fn run(&self, path: &Path) -> calibrant::Result<Done> {
        let mut file = read_accelerometer(path, &self.read, &self.device)?;
        // once for all that follows: holds, validation, report
        let sparks = self.holds.as_ref().and_then(|_| sparks_taken_out(&mut file.recording));
        let mut calibration = calibrate(&self.problem(&file.recording), &self.settings)
            .map_err(|error| in_file(error, path))?;
        calibration.warnings.splice(0..0, sparks);
        let input = Input {
            file: name(path),
            sha256: file.sha256.clone(),
            samples: file.recording.len(),
            rate_hz: file.recording.rate_hz(),
        };
        Ok(Done { file, calibration, validations: Vec::new(), input })
    }

    fn problem<'a>(&'a self, recording: &'a Recording) -> CalibrationProblem<'a> {
        let stimulus = match (&self.command, &self.holds) {
            (Some(command), _) => Stimulus::Motion(command),
            (None, Some(setup)) => Stimulus::Holds(setup),
            (None, None) => unreachable!("an experiment has a motion or holds"),
        };
        CalibrationProblem { sensor: &self.experiment.sensor, recording, stimulus }
    }

    /// Calibrates one of several recordings.
    fn one_of_many(&self, path: &Path, directory: &Path, arguments: &Arguments) -> many::Outcome {
        let done = self.run(path).and_then(|done| self.write(&done, path, directory).map(|()| done));
        match done {
            Err(error) => many::Outcome { findings: Vec::new(), calibrated: Err(error) },
            Ok(Done { file, calibration, validations, input }) => many::Outcome {
                findings: file.findings,
                calibrated: Ok(many::Calibrated {
                    status: calibration.status,
                    cells: vec![calibration.fit.p_value.map_or_else(|| "–".into(), number::probability)],
                    summary: Summary::of(&calibration),
                    json: arguments.json.then(|| calibration_json(&calibration, &validations, &input)),
                    warnings: calibration.warnings,
                }),
            },
        }
    }

    /// Writes calibration.json and report.html.
    fn write(&self, done: &Done, path: &Path, directory: &Path) -> calibrant::Result<()> {
        write_calibration(
            &directory.join("calibration.json"),
            &done.calibration,
            &done.validations,
            &done.input,
        )?;
        if !self.report {
            warn_of_earlier_report(directory);
            return Ok(());
        }
        let recording = &done.file.recording;
        let about = About {
            title: format!("Calibration from {}", name(path)),
            facts: vec![
                ("Recording".into(), path.display().to_string()),
                ("SHA-256".into(), done.input.sha256.clone()),
                (
                    "Samples".into(),
                    format!(
                        "{} at {} Hz, {} to {} s",
                        number::count(recording.len()),
                        number::significant(done.input.rate_hz, 5),
                        number::significant(recording.times_s.first().copied().unwrap_or(0.0), 6),
                        number::significant(recording.times_s.last().copied().unwrap_or(0.0), 6)
                    ),
                ),
                ("Experiment".into(), self.experiment_file.display().to_string()),
                (
                    "Prior".into(),
                    if self.settings.datasheet_prior { "datasheet".into() } else { "none".into() },
                ),
            ],
            findings: done.file.findings.iter().map(ToString::to_string).collect(),
            validations: done.validations.clone(),
            program: format!("calibrant {}", env!("CARGO_PKG_VERSION")),
            ..About::default()
        };
        let html = calibration_report(&done.calibration, recording, &about);
        write_atomically(&directory.join("report.html"), |out| out.write_all(html.as_bytes()))
    }
}

fn show(done: &Done, arguments: &Arguments) {
    for finding in &done.file.findings {
        console::finding(&done.input.file, finding);
    }
    for warning in &done.calibration.warnings {
        console::warn(warning);
    }
    if arguments.json {
        return console::print(&calibration_json(&done.calibration, &done.validations, &done.input));
    }
    if let Recovered::Holds(holds) = &done.calibration.recovered {
        console::print(&(console::holds(holds) + "\n"));
    }
    console::print(&console::parameters(&done.calibration));
    console::print(&console::fit(&done.calibration));
    console::print(&console::validations(&done.validations));
    console::print(&format!("\n{}\n", arguments.main_result().display()));
}
