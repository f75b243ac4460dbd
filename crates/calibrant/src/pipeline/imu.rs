//! A whole IMU, stage by stage.

use super::clean::take_out_outliers;
use super::duplicates::refuse_duplicate;
use super::holds::{with_holds, with_holds_of_other};
use super::noise::{NoiseInHold, calibrated_with_noise};
use super::note::Note;
use super::options::PipelineOptions;
use super::outcome::{Outcome, SensorCalibration};
use super::read_imu::ImuReader;
use super::recorded::Recorded;
use super::report::about_imu;
use super::sections::setup_of;
use super::source::Source;
use super::temperature::extrapolation_in_words;
use super::validation::{on_recording, unless_too_few};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{
    CalibrationSettings, ImuCalibration, ImuProblem, ImuSetup, Validation, calibrate_imu_with,
    cross_validate_imu, other_temperature, validate_imu,
};
use calibrant_core::noise::SensorNoise;
use calibrant_core::sensor::{Sensor, SensorKind, Temperatures};
use calibrant_io::{Experiment, HoldsPlan, ImuPlan, Plan, file_name};
use calibrant_report::message;

/// What the recordings of an IMU share.
pub(crate) struct ImuTask<'e> {
    accelerometer: &'e Sensor,
    plan: &'e ImuPlan,
    holds: &'e HoldsPlan,
    reader: ImuReader<'e>,
    settings: CalibrationSettings,
}

impl<'e> ImuTask<'e> {
    pub(crate) fn new(
        experiment: &'e Experiment,
        plan: &'e ImuPlan,
        options: &PipelineOptions,
    ) -> Result<Self> {
        let Plan::Holds(holds) = &experiment.plan else {
            return Err(Error::experiment(InputError::new(
                Refusal::ExperimentUnsuited,
                "an IMU needs [holds]",
                "see `calibrant init imu`",
            )));
        };
        Ok(Self {
            accelerometer: &experiment.sensor,
            plan,
            holds,
            reader: ImuReader::new(experiment, plan, options),
            settings: CalibrationSettings::default(),
        })
    }

    /// Calibrates from one recording.
    pub(crate) fn run(
        &self,
        source: &Source,
        options: &PipelineOptions,
        notes: &mut Vec<Note>,
    ) -> Result<Outcome> {
        let mut recorded = self.reader.read(source)?;
        notes.extend(Note::of_findings(&recorded.findings, source));
        let mut setup = setup_of(self.plan, self.holds, source, &recorded.recording, notes)?;
        let outliers = take_out_outliers(&mut recorded.recording);
        setup.holds = with_holds(&setup.holds, &recorded.recording);
        let (mut calibration, noise) = self.calibrate(source, &recorded, &setup, options.report)?;
        calibration.warnings.splice(0..0, outliers);
        calibration.warnings.extend(noise.gyroscope.iter().flat_map(SensorNoise::of_outliers));
        setup.white_noise = noise.white_noise;
        let validations = self.validations(options, &calibration, &recorded, &setup, notes)?;
        let inputs = recorded.inputs(source);
        let (noise, about) = match options.report {
            false => (Vec::new(), None),
            true => {
                let about = about_imu(&recorded, &inputs, options);
                let about = calibrant_report::About { validations: validations.clone(), ..about };
                (noise.physical(&calibration, &recorded.recording)?, Some(about))
            }
        };
        Ok(Outcome {
            calibration: SensorCalibration::Imu(Box::new(calibration)),
            validations,
            noise,
            notes: Vec::new(),
            inputs,
            recording: recorded.recording,
            about,
            allowed: options.allowed.clone(),
        })
    }

    fn problem<'a>(&'a self, recorded: &'a Recorded, setup: &'a ImuSetup) -> ImuProblem<'a> {
        ImuProblem {
            accelerometer: self.accelerometer,
            gyroscope: &self.plan.gyroscope,
            recording: &recorded.recording,
            setup,
        }
    }

    /// Calibrates, and finds the noise in the longest hold beside that.
    fn calibrate(
        &self,
        source: &Source,
        recorded: &Recorded,
        setup: &ImuSetup,
        report: bool,
    ) -> Result<(ImuCalibration, NoiseInHold)> {
        let problem = self.problem(recorded, setup);
        let (calibration, noise) =
            calibrated_with_noise(&recorded.recording, &setup.holds, report, |white_noise| {
                calibrate_imu_with(&problem, &self.settings, white_noise)
            });
        Ok((calibration.map_err(|error| error.in_recording(&source.recording))?, noise))
    }

    fn validations(
        &self,
        options: &PipelineOptions,
        calibration: &ImuCalibration,
        recorded: &Recorded,
        setup: &ImuSetup,
        notes: &mut Vec<Note>,
    ) -> Result<Vec<Validation>> {
        let mut validations = Vec::new();
        if let Some(other) = &options.validate {
            validations.push(self.on_other(calibration, (recorded, setup), other, notes)?);
        }
        if let Some(folds) = options.folds {
            let problem = self.problem(recorded, setup);
            let outcome = cross_validate_imu(calibration, &problem, &self.settings, folds);
            validations.extend(unless_too_few(outcome, notes)?);
        }
        Ok(validations)
    }

    /// Tries the calibration on another recording.
    fn on_other(
        &self,
        calibration: &ImuCalibration,
        (recorded, setup): (&Recorded, &ImuSetup),
        source: &Source,
        notes: &mut Vec<Note>,
    ) -> Result<Validation> {
        let path = source.recording.as_path();
        let warning = |words: String| Note::Warning(format!("{}: {words}", file_name(path)));
        let mut other = self.reader.read_other(source)?;
        notes.extend(Note::of_findings(&other.findings, source));
        let outliers = take_out_outliers(&mut other.recording);
        notes.extend(outliers.iter().map(|found| warning(message(found))));
        let gyroscope_path = source.gyroscope.as_deref().unwrap_or(path);
        for (sensor_kind, path) in
            [(SensorKind::Accelerometer, path), (SensorKind::Gyroscope, gyroscope_path)]
        {
            let [one, two] = [recorded, &other].map(|recorded| recorded.readings(sensor_kind));
            refuse_duplicate(sensor_kind, &one, &calibration.holds, &two, path)?;
        }
        let setup = ImuSetup {
            holds: with_holds_of_other(&setup.holds, &other.recording),
            latitude_deg: setup.latitude_deg,
            ..ImuSetup::default()
        };
        let mut validation = validate_imu(calibration, &self.problem(&other, &setup))
            .map_err(|error| error.in_recording(path))?;
        let temperature = other_temperature(calibration, &validation, &recorded.recording, &other.recording);
        validation.reasons.extend(temperature);
        let thermal = &calibration.imu.thermal;
        let range = Temperatures::of(&other.recording)?.and_then(|temperatures| temperatures.range_c());
        notes.extend(range.and_then(|range| extrapolation_in_words(thermal, range)).map(warning));
        Ok(on_recording(path, validation))
    }
}
