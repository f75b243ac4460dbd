//! Reads the recordings of an experiment, whatever the sensors.

use super::options::SessionOptions;
use super::read_imu::ImuReader;
use super::recorded::Recorded;
use super::source::Source;
use calibrant_core::error::Result;
use calibrant_core::sensor::{ReadingUnit, SensorKind};
use calibrant_io::{AccelerometerOnly, Experiment, ImuFile, ImuReadOptions};

/// How the recordings are read.
pub(crate) enum Reader<'e> {
    /// Those of an accelerometer alone, in a file of its own or among the columns of a device.
    Accelerometer(Box<ImuReadOptions>),
    /// Those of an IMU.
    Imu(Box<ImuReader<'e>>),
}

impl<'e> Reader<'e> {
    pub(crate) fn of(experiment: &'e Experiment, options: &SessionOptions) -> Self {
        match &experiment.imu {
            Some(plan) => Self::Imu(Box::new(ImuReader::new(experiment, plan, options))),
            None => {
                let sensor = &experiment.sensor;
                let given = ImuReadOptions {
                    counts_unless_stated: [sensor.unit == ReadingUnit::Counts, false],
                    accelerometer_only: Some(AccelerometerOnly {
                        axes: sensor.axes,
                        unit: sensor.unit,
                        with_temperature: experiment.campaign_section().is_some(),
                    }),
                    ..ImuReadOptions::default()
                };
                let given = given.or(options.reading.clone()).or(experiment.columns.clone());
                Self::Accelerometer(Box::new(given))
            }
        }
    }

    /// Reads the recording to calibrate from.
    pub(crate) fn read(&self, source: &Source) -> Result<Recorded> {
        match self {
            Self::Accelerometer(options) => Recorded::accelerometer_from(source, options),
            Self::Imu(reader) => reader.read(source),
        }
    }

    /// The file or files of a recording as they are read.
    pub(crate) fn file(&self, source: &Source) -> Result<ImuFile> {
        match self {
            Self::Accelerometer(options) => source.recording.read(options),
            Self::Imu(reader) => source.read_imu(reader.options()),
        }
    }

    /// Reads the recording that a calibration of these sensors is tried on.
    pub(crate) fn read_other(&self, source: &Source, sensor_kinds: &[SensorKind]) -> Result<Recorded> {
        match self {
            Self::Imu(reader) if sensor_kinds.contains(&SensorKind::Gyroscope) => reader.read_other(source),
            _ => self.read(source),
        }
    }
}
