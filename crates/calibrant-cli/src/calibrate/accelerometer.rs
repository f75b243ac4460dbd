//! Calibrations of an accelerometer.

use super::arguments::{Arguments, Unit};
use super::batch;
use super::earlier::warn_of_earlier_report;
use crate::diagnostics::Rules;
use crate::output_places::same_file;
use crate::recording_options::{in_file, name, spikes_taken_out};
use crate::{Exit, console};
use calibrant::Error;
use calibrant::error::InputError;
use calibrant::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, HoldsSetup, Recovered, Stimulus, Validation,
    calibrate,
};
use calibrant::io::{
    Experiment, ImuReadOptions, Input, Plan, Prior, ReadOptions, RecordingFile, Summary, calibration_json,
    read_accelerometer, read_motion, write_atomically, write_calibration,
};
use calibrant::motion::CommandedMotion;
use calibrant::report::{About, calibration_report, number_format};
use calibrant::sensor::{ReadingUnit, Recording};
use std::path::{Path, PathBuf};

/// What all recordings of a call share.
pub(super) struct Job {
    pub(super) experiment: Experiment,
    pub(super) experiment_file: PathBuf,
    pub(super) command: Option<CommandedMotion>,
    pub(super) holds: Option<HoldsSetup>,
    pub(super) settings: CalibrationSettings,
    pub(super) read: ReadOptions,
    pub(super) device: ImuReadOptions,
    pub(super) rules: Rules,
    /// Is a report to be written?
    pub(super) report: bool,
}

pub(super) struct Done {
    pub(super) file: RecordingFile,
    pub(super) calibration: Calibration,
    pub(super) validations: Vec<Validation>,
    pub(super) input: Input,
}

impl Job {
    pub(super) fn prepare(arguments: &Arguments, experiment: Experiment) -> calibrant::Result<Self> {
        if !arguments.gyroscope.is_empty() || arguments.sections.is_some() {
            console::warn("--gyroscope and --sections are not used: they are for kind = \"imu\"");
        }
        let (mut command, mut holds) = (None, None);
        match &experiment.plan {
            Plan::Motion(plan) => {
                let path = arguments.motion.as_deref().ok_or_else(|| {
                    Error::Experiment(Box::new(InputError::new(
                        "a [motion] experiment needs the commanded motion",
                        "add --motion FILE with columns t_s,ax_mps2,ay_mps2,az_mps2 at the nodes; trust unknown uses only its first and last row",
                    )))
                })?;
                if let Some(recording) =
                    arguments.recordings.iter().find(|recording| same_file(recording, path))
                {
                    return Err(Error::Experiment(Box::new(InputError::new(
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
        let rules = arguments.rules.clone();
        Ok(Self { experiment, experiment_file, command, holds, settings, read, device, rules, report })
    }

    pub(super) fn run(&self, path: &Path) -> calibrant::Result<Done> {
        let mut file = read_accelerometer(path, &self.read, &self.device)?;
        // once for all that follows: holds, validation, report
        let spikes = self.holds.as_ref().and_then(|_| spikes_taken_out(&mut file.recording));
        let mut calibration = calibrate(&self.problem(&file.recording), &self.settings)
            .map_err(|error| in_file(error, path))?;
        calibration.warnings.splice(0..0, spikes);
        let input = Input {
            file: name(path),
            sha256: file.sha256.clone(),
            samples: file.recording.len(),
            rate_hz: file.recording.rate_hz(),
        };
        Ok(Done { file, calibration, validations: Vec::new(), input })
    }

    pub(super) fn problem<'a>(&'a self, recording: &'a Recording) -> CalibrationProblem<'a> {
        let stimulus = match (&self.command, &self.holds) {
            (Some(command), _) => Stimulus::Motion(command),
            (None, Some(setup)) => Stimulus::Holds(setup),
            (None, None) => unreachable!("an experiment has a motion or holds"),
        };
        CalibrationProblem { sensor: &self.experiment.sensor, recording, stimulus }
    }

    /// Calibrates one of several recordings.
    pub(super) fn one_of_many(&self, path: &Path, directory: &Path, arguments: &Arguments) -> batch::Outcome {
        let done = self.run(path).and_then(|done| self.write(&done, path, directory).map(|()| done));
        match done {
            Err(error) => batch::Outcome { findings: Vec::new(), calibrated: Err(error) },
            Ok(Done { file, calibration, validations, input }) => batch::Outcome {
                findings: file.findings,
                calibrated: Ok(batch::Calibrated {
                    status: calibration.status,
                    cells: vec![
                        calibration.fit.p_value.map_or_else(|| "–".into(), number_format::probability),
                    ],
                    summary: Summary::of(&calibration),
                    json: arguments
                        .json
                        .then(|| calibration_json(&calibration, &validations, &input, &self.rules.words())),
                    warnings: calibration.warnings,
                }),
            },
        }
    }

    /// Writes calibration.json and report.html.
    pub(super) fn write(&self, done: &Done, path: &Path, directory: &Path) -> calibrant::Result<()> {
        write_calibration(
            &directory.join("calibration.json"),
            &done.calibration,
            &done.validations,
            &done.input,
            &self.rules.words(),
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
                        number_format::count(recording.len()),
                        number_format::significant(done.input.rate_hz, 5),
                        number_format::significant(recording.times_s.first().copied().unwrap_or(0.0), 6),
                        number_format::significant(recording.times_s.last().copied().unwrap_or(0.0), 6)
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

/// Prints what came of it; the exit status is that of the diagnostics that are denied.
pub(super) fn show(done: &Done, arguments: &Arguments) -> Exit {
    for finding in &done.file.findings {
        console::finding(&done.input.file, finding);
    }
    let exit = arguments.rules.show(&done.calibration.warnings, "");
    if arguments.json {
        let words = arguments.rules.words();
        console::print(&calibration_json(&done.calibration, &done.validations, &done.input, &words));
        return exit;
    }
    if let Recovered::Holds(holds) = &done.calibration.recovered {
        console::print(&(console::holds(holds) + "\n"));
    }
    console::print(&console::parameters(&done.calibration));
    console::print(&console::fit(&done.calibration));
    console::print(&console::validations(&done.validations));
    console::print(&format!("\n{}\n", arguments.main_result().display()));
    exit
}
