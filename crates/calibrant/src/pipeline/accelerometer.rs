//! An accelerometer alone, stage by stage: from a commanded motion, or from holds.

use super::clean::take_out_outliers;
use super::duplicates::refuse_duplicate;
use super::holds::{with_holds, with_holds_of_other};
use super::note::Note;
use super::options::PipelineOptions;
use super::outcome::{Outcome, SensorCalibration};
use super::recorded::Recorded;
use super::report::about_accelerometer;
use super::source::Source;
use super::validation::{on_recording, unless_too_few};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{
    Calibration, CalibrationProblem, CalibrationSettings, HoldsSetup, Recovered, Stimulus, Validation,
    calibrate, cross_validate, validate,
};
use calibrant_core::motion::CommandedMotion;
use calibrant_core::sensor::{Recording, Sensor, SensorKind};
use calibrant_io::{
    Experiment, HoldsPlan, ImuReadOptions, MotionPlan, Plan, Prior, ReadOptions, file_name, read_motion,
};
use calibrant_report::message;

/// What the recordings of an accelerometer share.
pub(crate) struct AccelerometerTask<'e> {
    sensor: &'e Sensor,
    known: Known,
    settings: CalibrationSettings,
    read: ReadOptions,
    device: ImuReadOptions,
}

/// What is known of the stimulus.
enum Known {
    Motion(CommandedMotion),
    Holds(HoldsSetup),
}

impl Known {
    fn stimulus(&self) -> Stimulus<'_> {
        match self {
            Self::Motion(command) => Stimulus::Motion(command),
            Self::Holds(setup) => Stimulus::Holds(setup),
        }
    }
}

impl<'e> AccelerometerTask<'e> {
    /// Reads what all recordings need.
    pub(crate) fn new(
        experiment: &'e Experiment,
        options: &PipelineOptions,
        notes: &mut Vec<Note>,
    ) -> Result<Self> {
        let known = match &experiment.plan {
            Plan::Motion(plan) => Known::Motion(commanded(plan, experiment, options, notes)?),
            Plan::Holds(plan) => Known::Holds(setup(plan)),
        };
        Ok(Self {
            sensor: &experiment.sensor,
            known,
            settings: CalibrationSettings {
                datasheet_prior: experiment.calibrate.prior == Prior::Datasheet,
                ..CalibrationSettings::default()
            },
            read: ReadOptions {
                unit: options.unit,
                expected_unit: experiment.sensor.unit,
                axes: experiment.sensor.axes,
            },
            device: options.reading.clone().or(experiment.columns.clone()),
        })
    }

    /// Calibrates from one recording.
    pub(crate) fn run(
        &self,
        source: &Source,
        options: &PipelineOptions,
        notes: &mut Vec<Note>,
    ) -> Result<Outcome> {
        let mut recorded = Recorded::accelerometer_from(source, &self.read, &self.device)?;
        let (outliers, known) = self.prepared(&mut recorded);
        let problem = self.problem(recorded.accelerometer()?, known.stimulus());
        let mut calibration =
            calibrate(&problem, &self.settings).map_err(|error| error.in_recording(&source.recording))?;
        calibration.warnings.splice(0..0, outliers);
        let validations = self.validations(options, &calibration, &recorded, &problem, notes)?;
        notes.extend(Note::of_findings(&recorded.findings, source));
        let inputs = recorded.inputs(source);
        let about = options.report.then(|| {
            let about = about_accelerometer(source, &recorded, &inputs, options, &self.settings);
            calibrant_report::About { validations: validations.clone(), ..about }
        });
        Ok(Outcome {
            calibration: SensorCalibration::Accelerometer(Box::new(calibration)),
            validations,
            noise: Vec::new(),
            notes: Vec::new(),
            inputs,
            recording: recorded.recording,
            about,
            allowed: options.allowed.clone(),
        })
    }

    /// Takes outliers out and finds the holds, where there are some. A motion has neither.
    fn prepared(&self, recorded: &mut Recorded) -> (Vec<Diagnostic>, Known) {
        match &self.known {
            Known::Motion(command) => (Vec::new(), Known::Motion(command.clone())),
            Known::Holds(setup) => {
                let outliers = take_out_outliers(&mut recorded.recording);
                (outliers, Known::Holds(with_holds(setup, &recorded.recording)))
            }
        }
    }

    fn problem<'a>(&'a self, recording: &'a Recording, stimulus: Stimulus<'a>) -> CalibrationProblem<'a> {
        CalibrationProblem { sensor: self.sensor, recording, stimulus }
    }

    fn validations(
        &self,
        options: &PipelineOptions,
        calibration: &Calibration,
        recorded: &Recorded,
        problem: &CalibrationProblem<'_>,
        notes: &mut Vec<Note>,
    ) -> Result<Vec<Validation>> {
        let mut validations = Vec::new();
        if let Some(other) = &options.validate {
            validations.push(self.on_other(calibration, recorded, other, notes)?);
        }
        if let Some(folds) = options.folds {
            let outcome = cross_validate(calibration, problem, &self.settings, folds);
            validations.extend(unless_too_few(outcome, notes)?);
        }
        Ok(validations)
    }

    /// Tries the calibration on another recording.
    fn on_other(
        &self,
        calibration: &Calibration,
        recorded: &Recorded,
        source: &Source,
        notes: &mut Vec<Note>,
    ) -> Result<Validation> {
        let path = source.recording.as_path();
        let mut other = Recorded::accelerometer_from(source, &self.read, &self.device)?;
        notes.extend(Note::of_findings(&other.findings, source));
        let known = match &self.known {
            Known::Motion(command) => Known::Motion(command.clone()),
            Known::Holds(setup) => {
                let outliers = take_out_outliers(&mut other.recording);
                let warning = |found| Note::Warning(format!("{}: {}", file_name(path), message(&found)));
                notes.extend(outliers.into_iter().map(warning));
                Known::Holds(with_holds_of_other(setup, &other.recording))
            }
        };
        if let Recovered::Holds(holds) = &calibration.recovered {
            let [one, two] = [recorded, &other].map(|recorded| recorded.readings(SensorKind::Accelerometer));
            refuse_duplicate(SensorKind::Accelerometer, &one, holds, &two, path)?;
        }
        let problem = self.problem(other.accelerometer()?, known.stimulus());
        let validation = validate(calibration, &problem).map_err(|error| error.in_recording(path))?;
        Ok(on_recording(path, validation))
    }
}

/// The commanded motion of a `[motion]` experiment.
fn commanded(
    plan: &MotionPlan,
    experiment: &Experiment,
    options: &PipelineOptions,
    notes: &mut Vec<Note>,
) -> Result<CommandedMotion> {
    let path = options.motion.as_deref().ok_or_else(|| {
        Error::experiment(InputError::new(Refusal::KeyMissing,
            "a [motion] experiment needs the commanded motion",
            "add --motion FILE with columns t_s,ax_mps2,ay_mps2,az_mps2 at the nodes; trust unknown uses only its first and last row",
        ))
    })?;
    let motion = read_motion(path, experiment.sensor.axes)?;
    if motion.intervals() != plan.intervals {
        notes.push(Note::Remark(format!(
            "{} has {} intervals, the experiment file {}: the former counts",
            path.display(),
            motion.intervals(),
            plan.intervals
        )));
    }
    Ok(CommandedMotion { motion, trust: plan.trust, known_ends: plan.known_ends })
}

fn setup(plan: &HoldsPlan) -> HoldsSetup {
    HoldsSetup {
        gravity: plan.gravity,
        gauge: plan.gauge,
        intervals_s: plan.intervals_s.clone(),
        minimum_hold_s: plan.minimum_hold_s,
        found: None,
    }
}
