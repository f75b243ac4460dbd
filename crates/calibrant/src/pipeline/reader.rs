//! Reads the recordings of an experiment, whatever the sensors.

use super::options::PipelineOptions;
use super::read_imu::ImuReader;
use super::recorded::Recorded;
use super::source::Source;
use calibrant_core::error::Result;
use calibrant_io::{Experiment, ImuReadOptions, ReadOptions};

/// How the recordings are read.
pub(crate) enum Reader<'e> {
    /// Those of an accelerometer alone, in their own format or among the columns of a device.
    Accelerometer(ReadOptions, Box<ImuReadOptions>),
    /// Those of an IMU.
    Imu(Box<ImuReader<'e>>),
}

impl<'e> Reader<'e> {
    pub(crate) fn of(experiment: &'e Experiment, options: &PipelineOptions) -> Self {
        match &experiment.imu {
            Some(plan) => Self::Imu(Box::new(ImuReader::new(experiment, plan, options))),
            None => Self::Accelerometer(
                ReadOptions {
                    unit: options.unit,
                    expected_unit: experiment.sensor.unit,
                    axes: experiment.sensor.axes,
                },
                Box::new(options.reading.clone().or(experiment.columns.clone())),
            ),
        }
    }

    /// Reads the recording to calibrate from.
    pub(crate) fn read(&self, source: &Source) -> Result<Recorded> {
        match self {
            Self::Accelerometer(read, device) => Recorded::accelerometer_from(source, read, device),
            Self::Imu(reader) => reader.read(source),
        }
    }

    /// Reads the recording that a calibration is tried on.
    pub(crate) fn read_other(&self, source: &Source) -> Result<Recorded> {
        match self {
            Self::Accelerometer(..) => self.read(source),
            Self::Imu(reader) => reader.read_other(source),
        }
    }
}
