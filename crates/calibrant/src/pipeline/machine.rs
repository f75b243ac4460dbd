//! The stages from a recording on a machine to a calibration.

use super::calibrated::{Calibrated, MachineOutcome};
use super::clean::take_out_outliers_in_motion;
use super::duplicates::refuse_duplicate;
use super::machine_datasheet::beyond_datasheets;
use super::machine_log::LogFile;
use super::note::Note;
use super::options::PipelineOptions;
use super::outcome::Outcome;
use super::reader::Reader;
use super::recorded::Recorded;
use super::report::about;
use super::source::Source;
use super::validation::unless_too_few;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{
    Axis, ImuParameters, ImuQuantity, ImuRecording, ParameterList, Sensor, SensorKind, SensorModel,
};
use calibrant_io::{Experiment, ImuPlan, MachineLogInput, MachinePlan, ReferenceLogOptions, file_name};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::estimate::{
    MachineCalibration, MachineProblem, MachineSettings, MachineSetup, MachineValidation,
    MachineValidationSource, calibrate_on_machine, check_folds, compare_on_machine,
    cross_validate_on_machine,
};
use calibrant_machine::log::ReferenceLog;
use nalgebra::{Matrix3, Vector3};

/// What all recordings on a machine share.
pub(crate) struct MachineTask<'e> {
    accelerometer: &'e Sensor,
    imu: Option<&'e ImuPlan>,
    plan: &'e MachinePlan,
    chain: Option<KinematicChain>,
    /// The log that the options name. Without it, each recording's file has one.
    log: Option<LogFile>,
    log_options: ReferenceLogOptions,
    reader: Reader<'e>,
}

/// A recording, and the log of the machine's motion on its clock.
struct Moved {
    recorded: Recorded,
    outliers: Vec<Diagnostic>,
    log: ReferenceLog,
    log_input: MachineLogInput,
}

fn calibrated(problem: &MachineProblem<'_>, source: &Source) -> Result<MachineCalibration> {
    calibrate_on_machine(problem, &MachineSettings::default())
        .map_err(|error| error.in_recording(&source.recording))
}

impl<'e> MachineTask<'e> {
    /// Reads the machine, and the log that the options name.
    pub(crate) fn new(
        experiment: &'e Experiment,
        plan: &'e MachinePlan,
        options: &PipelineOptions,
        notes: &mut Vec<Note>,
    ) -> Result<Self> {
        let log_options = ReferenceLogOptions { topic: plan.log_topic.clone(), ..Default::default() };
        let motion = options.motion.as_deref();
        Ok(Self {
            accelerometer: &experiment.sensor,
            imu: experiment.imu.as_ref(),
            plan,
            chain: plan.source.as_ref().map(|source| source.chain()).transpose()?,
            log: motion.map(|path| LogFile::read(path, &log_options, notes)).transpose()?,
            log_options,
            reader: Reader::of(experiment, options),
        })
    }

    /// Calibrates from one recording.
    pub(crate) fn run(
        &self,
        source: &Source,
        options: &PipelineOptions,
        notes: &mut Vec<Note>,
    ) -> Result<Outcome> {
        let recorded = self.reader.read(source)?;
        let setup = self.setup();
        let moved = self.moved(source, recorded, (self.log.as_ref(), "--motion"), notes)?;
        let nominal = self.nominal()?;
        let quantities = self.quantities(&moved.recorded.recording);
        let problem = self.problem(&moved, &setup, &nominal, &quantities);
        // what is wrong with the options is said before the calibration takes its time
        if let Some(folds) = options.folds {
            check_folds(&problem, folds)?;
        }
        let other = (options.validate.as_ref())
            .map(|other| self.other(other, options, &moved, notes).map(|second| (other, second)))
            .transpose()?;
        let mut calibration = calibrated(&problem, source)?;
        calibration.warnings.splice(0..0, moved.outliers.iter().cloned());
        let beyond = beyond_datasheets(self.accelerometer, self.imu, &calibration);
        calibration.warnings.extend(beyond);
        let mut validations = Vec::new();
        if let Some((other, second)) = &other {
            let second = calibrated(&self.problem(second, &setup, &nominal, &quantities), other)?;
            let name = file_name(&other.recording);
            let source = MachineValidationSource::Recording { name };
            validations
                .push(MachineValidation { source, ..compare_on_machine(&calibration, &second, &setup) });
        }
        if let Some(folds) = options.folds {
            let outcome =
                cross_validate_on_machine(&problem, &calibration, &MachineSettings::default(), folds);
            validations.extend(unless_too_few(outcome, notes)?);
        }
        let Moved { recorded, log_input, .. } = moved;
        let origin = recorded.origin(source);
        let what = if self.imu.is_none() { "an accelerometer" } else { "an IMU" };
        let facts = [("Log", log_input.file.clone()), ("SHA-256 of the log", log_input.sha256.clone())];
        let about = about(&format!("{what} on a machine"), facts, &recorded, &origin.inputs, options);
        let outcome = MachineOutcome { calibration, setup, log: log_input, validations };
        Ok(Outcome {
            calibrated: Calibrated::OnMachine(Box::new(outcome)),
            validations: Vec::new(),
            noise: Vec::new(),
            notes: Vec::new(),
            limits: Vec::new(),
            findings: Vec::new(),
            origin,
            recording: recorded.recording,
            about,
            with_page: options.report,
            allowed: options.allowed.clone(),
        })
    }

    /// What is known beforehand.
    fn setup(&self) -> MachineSetup {
        let joints = self.chain.as_ref().map_or(0, |chain| chain.joints.len());
        self.plan.setup(self.accelerometer, self.imu, joints)
    }

    /// A recording beside its log: the given one, or that in its own file. An option gives it.
    fn moved(
        &self,
        source: &Source,
        mut recorded: Recorded,
        (log, option): (Option<&LogFile>, &str),
        notes: &mut Vec<Note>,
    ) -> Result<Moved> {
        notes.extend(Note::of_findings(&recorded.findings, source));
        let outliers = take_out_outliers_in_motion(&mut recorded.recording);
        let beside;
        let log = match log {
            Some(log) => log,
            None => {
                beside = LogFile::read_beside(&source.recording, &self.log_options, option, notes)?;
                &beside
            }
        };
        let (log, log_input) = log.for_recording(self.chain.as_ref(), recorded.counted_from_ns, notes)?;
        Ok(Moved { recorded, outliers, log, log_input })
    }

    /// The other recording of the sensor beside its log.
    fn other(
        &self,
        other: &Source,
        options: &PipelineOptions,
        moved: &Moved,
        notes: &mut Vec<Note>,
    ) -> Result<Moved> {
        let log = options.validate_motion.as_deref();
        let log = log.map(|path| LogFile::read(path, &self.log_options, notes)).transpose()?;
        let calibrated: Vec<_> = (SensorKind::ALL.into_iter())
            .filter(|sensor_kind| moved.recorded.recording.sensor(*sensor_kind).is_some())
            .collect();
        let read = self.reader.read_other(other, &calibrated)?;
        let second = self.moved(other, read, (log.as_ref(), "--validate-motion"), notes)?;
        for sensor_kind in calibrated {
            let [one, two] = [moved, &second].map(|of| of.recorded.readings(sensor_kind));
            refuse_duplicate(sensor_kind, &one, &two, other.file_of(sensor_kind))?;
        }
        Ok(second)
    }

    fn problem<'p>(
        &'p self,
        moved: &'p Moved,
        setup: &'p MachineSetup,
        nominal: &'p ImuParameters,
        quantities: &'p [ImuQuantity],
    ) -> MachineProblem<'p> {
        MachineProblem {
            recording: &moved.recorded.recording,
            log: &moved.log,
            chain: self.chain.as_ref(),
            setup,
            nominal,
            quantities,
        }
    }

    /// The sensors of the datasheets, where the search begins.
    fn nominal(&self) -> Result<ImuParameters> {
        let missing = |key: &str| {
            let message = "counts need a nominal gain on a machine: the search begins with it";
            Error::experiment(InputError::new(Refusal::KeyMissing, message, "add it").about_key(key))
        };
        let mut nominal = ImuParameters::identity();
        let Sensor { gain, offset, .. } = self.accelerometer;
        let gain = gain.ok_or_else(|| missing("sensor.gain_counts_per_mps2"))?;
        nominal.accelerometer.matrix = Matrix3::from_diagonal(&gain);
        nominal.accelerometer.bias = offset.unwrap_or_default();
        if let Some(gyroscope) = self.imu.map(|imu| &imu.gyroscope) {
            let in_si = gyroscope.unit == SensorKind::Gyroscope.stimulus_unit();
            let gain = gyroscope.gain.or(in_si.then(|| Vector3::repeat(1.0)));
            let gain = gain.ok_or_else(|| missing("gyroscope.gain_counts_per_radps"))?;
            nominal.gyroscope.matrix = Matrix3::from_diagonal(&gain);
        }
        Ok(nominal)
    }

    /// The parameters of the sensors that were recorded.
    fn quantities(&self, recording: &ImuRecording) -> Vec<ImuQuantity> {
        let of = |kind: SensorKind, model: SensorModel| {
            let list = ParameterList::new(3, model);
            let quantities = list.quantities().iter().map(|quantity| ImuQuantity::Of(kind, *quantity));
            quantities.collect::<Vec<_>>()
        };
        let mut quantities = Vec::new();
        if recording.accelerometer.is_some() {
            quantities.extend(of(SensorKind::Accelerometer, self.accelerometer.model));
        }
        if let (Some(imu), Some(_)) = (self.imu, &recording.gyroscope) {
            quantities.extend(of(SensorKind::Gyroscope, imu.gyroscope.model));
            if imu.gyroscope.g_sensitivity {
                let entries = Axis::ALL.into_iter().flat_map(|row| Axis::ALL.map(|column| (row, column)));
                quantities.extend(entries.map(|(row, column)| ImuQuantity::GSensitivity(row, column)));
            }
        }
        quantities
    }
}
