//! The stages from a recording to a calibration, whatever the sensors.

use super::calibrated::Calibrated;
use super::clean::{keep_knocks, take_out_repeats};
use super::duplicates::refuse_duplicate;
use super::kind::Kind;
use super::left_out::negligible;
use super::noise::NoiseInHold;
use super::options::SessionOptions;
use super::other_soaks::OtherSoaks;
use super::outcome::Outcome;
use super::reader::Reader;
use super::recorded::Recorded;
use super::report::about;
use super::setup::Setup;
use super::source::Source;
use super::validation::{extrapolated, on_recording, unless_too_few};
use calibrant_core::diagnostic::samples::KnocksKept;
use calibrant_core::diagnostic::{Diagnostic, Severity};
use calibrant_core::error::Result;
use calibrant_core::estimate::{
    Calibration, CalibrationSettings, SoakTemperature, Validation, other_temperature,
};
use calibrant_core::noise::SensorNoise;
use calibrant_core::sensor::{Sensor, SensorKind};
use calibrant_io::{Experiment, Prior, file_name};

/// What all recordings share.
pub(crate) struct Task<'e> {
    accelerometer: &'e Sensor,
    kind: Kind<'e>,
    reader: Reader<'e>,
    settings: CalibrationSettings,
    rows_are_holds: bool,
    others: &'e OtherSoaks,
}

impl<'e> Task<'e> {
    pub(crate) fn new(
        experiment: &'e Experiment,
        kind: Kind<'e>,
        options: &SessionOptions,
        others: &'e OtherSoaks,
    ) -> Self {
        Self {
            accelerometer: &experiment.sensor,
            kind,
            reader: Reader::of(experiment, options),
            rows_are_holds: options.reading.rows_are_holds,
            others,
            settings: CalibrationSettings {
                datasheet_prior: experiment.imu.is_none() && experiment.calibrate.prior == Prior::Datasheet,
                ..CalibrationSettings::default()
            },
        }
    }

    /// Calibrates from one recording.
    pub(crate) fn run(
        &self,
        source: &Source,
        options: &SessionOptions,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Outcome> {
        let mut recorded = self.reader.read(source)?;
        notes.extend(recorded.findings.iter().cloned());
        for further in &source.further {
            let read = self.reader.read(further)?;
            notes.extend(read.findings.iter().cloned());
            recorded.join(read, source, further)?;
        }
        let mut setup = self.kind.setup(source, &recorded.recording, notes)?;
        setup.set_recordings(&recorded);
        if self.rows_are_holds {
            setup.set_rows_as_holds(&recorded.recording)?;
        }
        let mut before = self.kind.missing(&recorded.recording);
        before.extend(take_out_repeats(&mut recorded.recording));
        let knocks = match self.kind {
            Kind::Imu(..) => recorded.recording.gyroscope_with_knocks(),
            _ => None,
        };
        before.extend(setup.prepare(self.accelerometer, &mut recorded.recording));
        before.extend(setup.set_faces(self.accelerometer, &recorded.recording)?);
        let soak_prior = setup.set_others(self.others);
        let taken_to_c = match &self.others.sensor {
            Some(imu) => setup.take_to_mean_temperature(imu, &recorded.recording)?,
            None => None,
        };
        let mut outcome = self.calibrate(source, &recorded, &setup, options.report);
        if let Some((gyroscope, samples, at_rest)) = knocks {
            let cut = recorded.recording[SensorKind::Gyroscope].replace(gyroscope);
            let kept = self.calibrate(source, &recorded, &setup, options.report);
            let better = kept.as_ref().ok().and_then(|(kept, _)| {
                KnocksKept::of(outcome.as_ref().ok().map(|(cut, _)| cut), kept, samples)
            });
            match better {
                Some(better) => {
                    notes.push(better.into());
                    keep_knocks(&mut before, at_rest.as_ref(), &recorded.recording);
                    outcome = kept;
                }
                None => recorded.recording[SensorKind::Gyroscope] = cut,
            }
        }
        let (mut calibration, noise) = outcome.inspect_err(|_| notes.extend(before.iter().cloned()))?;
        calibration.counts_per_unit = recorded.counts_per_unit;
        calibration.soak = SoakTemperature::of(&recorded.recording, calibration.hold_results())?
            .map(|soak| SoakTemperature { mean_c: taken_to_c.unwrap_or(soak.mean_c), ..soak });
        calibration.soak_prior = soak_prior;
        calibration.warnings.splice(0..0, before);
        calibration.warnings.extend(recorded.unused(calibration.hold_results()));
        calibration.warnings.extend(noise.gyroscope.iter().flat_map(SensorNoise::of_outliers));
        let mut allowed = options.allowed.clone();
        if let Some((note, codes)) =
            negligible(&calibration.warnings, &recorded.recording, Some(&calibration))
        {
            calibration.warnings.push(note);
            allowed.extend(codes);
        }
        setup.set_white_noise(noise.white_noise);
        let validations = self.validations(options, &calibration, (&recorded, &setup), notes)?;
        let origin = recorded.origin(source);
        let what = if calibration.gyroscope.is_none() { "an accelerometer" } else { "an IMU" };
        let prior = calibration.datasheet_prior.then(|| ("Prior", "datasheet".to_owned()));
        let about = calibrant_report::About {
            validations: validations.clone(),
            ..about(what, prior, &recorded, &origin.inputs, options)
        };
        let noise = match options.report {
            false => Vec::new(),
            true => noise.physical(&calibration, &recorded.recording)?,
        };
        Ok(Outcome {
            calibrated: Calibrated::Sensors(Box::new(calibration)),
            validations,
            noise,
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

    /// Calibrates, and finds the noise of an IMU in the longest hold beside that.
    fn calibrate(
        &self,
        source: &Source,
        recorded: &Recorded,
        setup: &Setup<'_>,
        report: bool,
    ) -> Result<(Calibration, NoiseInHold)> {
        let problem = setup.problem(self.accelerometer, recorded)?;
        let (calibration, noise) = problem.calibrate(&self.settings, report);
        Ok((calibration.map_err(|error| error.in_recording(source.path()))?, noise))
    }

    fn validations(
        &self,
        options: &SessionOptions,
        calibration: &Calibration,
        (recorded, setup): (&Recorded, &Setup<'_>),
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Vec<Validation>> {
        let mut validations = Vec::new();
        if let Some(other) = &options.validate {
            validations.push(self.on_other(calibration, (recorded, setup), other, notes)?);
        }
        if let Some(folds) = options.folds {
            let problem = setup.problem(self.accelerometer, recorded)?;
            let outcome = problem.cross_validate(calibration, &self.settings, folds);
            validations.extend(unless_too_few(outcome, notes)?);
        }
        validations.iter_mut().for_each(|validation: &mut Validation| validation.allow(&options.allowed));
        // warnings are told already
        let found = validations.iter().flat_map(Validation::diagnostics);
        notes.extend(found.filter(|found| found.severity() == Severity::Note));
        Ok(validations)
    }

    /// Tries the calibration on another recording.
    fn on_other(
        &self,
        calibration: &Calibration,
        (recorded, setup): (&Recorded, &Setup<'_>),
        source: &Source,
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Validation> {
        let path = source.path();
        let in_file = |found: Diagnostic| found.in_file(file_name(path));
        let mut other = self.reader.read_other(source, &calibration.sensor_kinds())?;
        notes.extend(other.findings.iter().cloned());
        let mut setup = setup.of_other();
        if self.rows_are_holds {
            setup.set_rows_as_holds(&other.recording)?;
        }
        let mut outliers = take_out_repeats(&mut other.recording);
        outliers.extend(setup.prepare(self.accelerometer, &mut other.recording));
        notes.extend(outliers.into_iter().map(in_file));
        for sensor_kind in calibration.sensor_kinds() {
            let [one, two] = [recorded, &other].map(|recorded| recorded.readings(sensor_kind));
            refuse_duplicate(sensor_kind, &one, &two, source.path_of(sensor_kind))?;
        }
        let problem = setup.problem(self.accelerometer, &other)?;
        let mut validation = problem.validate(calibration).map_err(|error| error.in_recording(path))?;
        let temperature = other_temperature(calibration, &validation, &recorded.recording, &other.recording);
        validation.likely_explanations.extend(temperature);
        notes.extend(extrapolated(&calibration.imu.thermal, &other.recording)?.map(in_file));
        Ok(on_recording(path, validation))
    }
}
