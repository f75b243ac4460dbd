//! The stages from a recording on a machine to a calibration.

use super::calibrated::{Calibrated, MachineOutcome};
use super::clean::take_out_outliers_in_motion;
use super::duplicates::refuse_duplicate;
use super::left_out::negligible;
use super::machine_datasheet::beyond_datasheets;
use super::machine_limits::beyond_limits;
use super::machine_log::LogFile;
use super::options::SessionOptions;
use super::outcome::Outcome;
use super::reader::Reader;
use super::recorded::Recorded;
use super::report::about;
use super::source::Source;
use super::validation::unless_too_few;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, Result, TaskOption};
use calibrant_core::sensor::{ImuParameters, ImuQuantity, SensorKind};
use calibrant_io::{Experiment, MachineLogInput, MachinePlan, Prior, file_name};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::estimate::{
    MachineCalibration, MachineProblem, MachineSettings, MachineSetup, MachineValidation,
    MachineValidationSource, calibrate_on_machine, check_folds, compare_on_machine,
    cross_validate_on_machine,
};
use calibrant_machine::log::ReferenceLog;

/// What all recordings on a machine share.
pub(crate) struct MachineTask<'e> {
    experiment: &'e Experiment,
    plan: &'e MachinePlan,
    chain: Option<&'e KinematicChain>,
    /// The log that the options name. Without it, each recording's file has one.
    log: Option<&'e LogFile>,
    reader: Reader<'e>,
}

/// A recording, and the log of the machine's motion on its clock.
struct Moved {
    recorded: Recorded,
    outliers: Vec<Diagnostic>,
    log: ReferenceLog,
    log_input: MachineLogInput,
    /// Distance of the knots, s, where the log states it.
    knot_step_s: Option<f64>,
}

fn calibrated(
    problem: &MachineProblem<'_>,
    settings: &MachineSettings,
    source: &Source,
) -> Result<MachineCalibration> {
    calibrate_on_machine(problem, settings).map_err(|error| error.in_recording(source.path()))
}

impl<'e> MachineTask<'e> {
    pub(crate) fn new(
        experiment: &'e Experiment,
        plan: &'e MachinePlan,
        (chain, log): (Option<&'e KinematicChain>, Option<&'e LogFile>),
        options: &SessionOptions,
    ) -> Self {
        Self { experiment, plan, chain, log, reader: Reader::of(experiment, options) }
    }

    /// Calibrates from one recording.
    pub(crate) fn run(
        &self,
        source: &Source,
        options: &SessionOptions,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Outcome> {
        let recorded = self.reader.read(source)?;
        let setup = self.setup()?;
        let moved = self.moved(source, recorded, (self.log, TaskOption::Motion), notes)?;
        let on_knots_of = |moved: &Moved| MachineSetup {
            knot_step_s: setup.knot_step_s.or(moved.knot_step_s),
            ..setup.clone()
        };
        let (setup_of_other, setup) = (&on_knots_of, on_knots_of(&moved));
        let nominal = self.experiment.nominal()?;
        let quantities = self.experiment.quantities(&moved.recorded.recording);
        let settings = &options.machine_settings();
        let problem = self.problem(&moved, &setup, &nominal, &quantities);
        let what = format!("a calibration from a log of {} rows", moved.log.times_s().len());
        let budget = options.reading.budget.unwrap_or_default();
        budget.check(problem.work(), &what, "thin out the log, or split it").map_err(Error::Experiment)?;
        // what is wrong with the options is said before the calibration takes its time
        if let Some(folds) = options.folds {
            check_folds(&problem, folds)?;
        }
        let other = (options.validate.as_ref())
            .map(|other| self.other(other, options, &moved, notes).map(|second| (other, second)))
            .transpose()?;
        let mut calibration = calibrated(&problem, settings, source)?;
        calibration.sensors.warnings.splice(0..0, moved.outliers.iter().cloned());
        let Experiment { sensor: accelerometer, imu, calibrate, .. } = self.experiment;
        calibration.sensors.counts_per_unit = moved.recorded.counts_per_unit;
        calibration.sensors.datasheet_prior = calibrate.prior == Prior::Datasheet;
        let beyond = beyond_datasheets(accelerometer, imu.as_ref(), &calibration);
        calibration.sensors.warnings.extend(beyond);
        calibration.sensors.warnings.extend(beyond_limits(&moved.log, self.chain));
        let mut allowed = options.allowed.clone();
        if let Some((note, codes)) =
            negligible(&calibration.sensors.warnings, &moved.recorded.recording, None)
        {
            calibration.sensors.warnings.push(note);
            allowed.extend(codes);
        }
        let mut validations = Vec::new();
        if let Some((other, second)) = &other {
            let setup = setup_of_other(second);
            let second = calibrated(&self.problem(second, &setup, &nominal, &quantities), settings, other)?;
            let name = file_name(other.path());
            let source = MachineValidationSource::Recording { name };
            validations
                .push(MachineValidation { source, ..compare_on_machine(&calibration, &second, &setup) });
        }
        if let Some(folds) = options.folds {
            let outcome = cross_validate_on_machine(&problem, &calibration, settings, folds);
            validations.extend(unless_too_few(outcome, notes)?);
        }
        let Moved { recorded, log_input, .. } = moved;
        let origin = recorded.origin(source);
        let what = if imu.is_none() { "an accelerometer" } else { "an IMU" };
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
            allowed,
        })
    }

    /// What is known beforehand.
    fn setup(&self) -> Result<MachineSetup> {
        let joints = self.chain.map_or(0, |chain| chain.joints.len());
        let mut setup = self.plan.setup(&self.experiment.sensor, self.experiment.imu.as_ref(), joints)?;
        for term in self.experiment.datasheet_terms() {
            // what [known] says of a parameter is nearer than the datasheet
            if setup.known.iter().all(|known| known.quantity != term.quantity) {
                setup.known.push(term);
            }
        }
        Ok(setup)
    }

    /// A recording beside its log: the given one, or that in its own file. An option gives it.
    fn moved(
        &self,
        source: &Source,
        mut recorded: Recorded,
        (log, option): (Option<&LogFile>, TaskOption),
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Moved> {
        notes.extend(recorded.findings.iter().cloned());
        let outliers = take_out_outliers_in_motion(&mut recorded.recording);
        let beside;
        let log = match log {
            Some(log) => log,
            None => {
                beside = LogFile::read_beside(&source.recording, &self.plan.log_options(), option, notes)?;
                &beside
            }
        };
        let knot_step_s = log.knot_step_s();
        let (log, log_input) = log.for_recording(self.chain, recorded.counted_from_ns, notes)?;
        Ok(Moved { recorded, outliers, log, log_input, knot_step_s })
    }

    /// The other recording of the sensor beside its log.
    fn other(
        &self,
        other: &Source,
        options: &SessionOptions,
        moved: &Moved,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Moved> {
        let log = options.validate_motion.as_ref();
        let log = log.map(|log| LogFile::read(log, &self.plan.log_options(), notes)).transpose()?;
        let calibrated: Vec<_> = (SensorKind::ALL.into_iter())
            .filter(|sensor_kind| moved.recorded.recording.sensor(*sensor_kind).is_some())
            .collect();
        let read = self.reader.read_other(other, &calibrated)?;
        let second = self.moved(other, read, (log.as_ref(), TaskOption::ValidateMotion), notes)?;
        for sensor_kind in calibrated {
            let [one, two] = [moved, &second].map(|of| of.recorded.readings(sensor_kind));
            refuse_duplicate(sensor_kind, &one, &two, other.path_of(sensor_kind))?;
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
            chain: self.chain,
            setup,
            nominal,
            quantities,
        }
    }
}
