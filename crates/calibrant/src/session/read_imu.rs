//! Reads recordings of an IMU: what the caller says of them first, then `[columns]`, then the units of the sensors.

use super::options::SessionOptions;
use super::recorded::Recorded;
use super::source::Source;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{ReadingUnit, SensorKind};
use calibrant_io::{Experiment, ImuPlan, ImuReadOptions, ImuUnit};
use std::path::PathBuf;

/// How the recordings of an IMU are read.
pub(crate) struct ImuReader<'e> {
    experiment_file: PathBuf,
    columns: &'e ImuReadOptions,
    /// What the caller says.
    given: ImuReadOptions,
    /// The same, and what the experiment says.
    options: ImuReadOptions,
}

impl<'e> ImuReader<'e> {
    pub(crate) fn new(experiment: &'e Experiment, plan: &ImuPlan, options: &SessionOptions) -> Self {
        let sensors = ImuReadOptions {
            accelerometer_unit: (experiment.sensor.unit == ReadingUnit::Counts).then_some(ImuUnit::Counts),
            gyroscope_unit: plan.file_unit,
            ..ImuReadOptions::default()
        };
        Self {
            experiment_file: options.experiment_file.clone(),
            columns: &experiment.columns,
            given: options.reading.clone(),
            options: options.reading.clone().or(experiment.columns.clone()).or(sensors),
        }
    }

    /// What is said of the recordings.
    pub(crate) fn options(&self) -> &ImuReadOptions {
        &self.options
    }

    /// Reads the recording to calibrate from.
    pub(crate) fn read(&self, source: &Source) -> Result<Recorded> {
        Recorded::imu_from(source, &self.options)
            .map_err(|error| self.contradicted_key(source).unwrap_or(error))
    }

    /// Reads the recording that a calibration is tried on; where it lacks its gyroscope, the option that gives it is named.
    pub(crate) fn read_other(&self, source: &Source) -> Result<Recorded> {
        let help = "give the gyroscope's file of that recording with option `validate_gyroscope`";
        match Recorded::imu_from(source, &self.options) {
            Ok(recorded)
                if source.gyroscope.is_none() && recorded.recording[SensorKind::Gyroscope].is_none() =>
            {
                let message = "the recording has no gyroscope";
                Err(Error::recording(
                    InputError::new(Refusal::SensorMissing, message, help).in_file(source.path()),
                ))
            }
            Err(Error::Recording(input_error))
                if source.gyroscope.is_none() && input_error.code == Refusal::SensorUnnamed =>
            {
                Err(Error::recording(input_error.with_help(help)))
            }
            read => read,
        }
    }

    /// A unit that the experiment file says and the recording contradicts, where that is why the recording cannot be read.
    fn contradicted_key(&self, source: &Source) -> Option<Error> {
        let of_experiment = |sensor_kind: &SensorKind| {
            self.given.unit(*sensor_kind).is_none() && self.options.unit(*sensor_kind).is_some()
        };
        SensorKind::ALL.into_iter().filter(of_experiment).find_map(|sensor_kind| {
            // it can be read without that unit only if it states another
            Recorded::imu_from(source, &self.options.clone().with_unit(sensor_kind, None)).ok()?;
            let key = match (self.columns.unit(sensor_kind), sensor_kind) {
                (Some(_), _) => format!("columns.{sensor_kind}_unit"),
                (None, SensorKind::Accelerometer) => "sensor.unit".into(),
                (None, SensorKind::Gyroscope) => "gyroscope.unit".into(),
            };
            let message = format!(
                "`{key}` is {}, but the recording states another unit of the {sensor_kind}",
                self.options.unit(sensor_kind)?.symbol()
            );
            let help = "correct it, or name the columns in [columns] to overrule the file; `calibrant inspect` says what it states";
            Some(Error::experiment(InputError::new(Refusal::UnitContradicted, message, help).in_file(&self.experiment_file)))
        })
    }
}
