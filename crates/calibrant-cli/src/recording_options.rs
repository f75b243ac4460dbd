//! The options of all commands that read a recording. They state what its file does not.

use crate::budget::budget;
use calibrant::io::{FileFormat, ImuReadOptions, ImuUnit, SampleTimes, TimeUnit, read_columns};
use calibrant::sensor::{SensorKind, WORKING_C};
use std::path::Path;

#[derive(clap::Args, Clone)]
pub(crate) struct RecordingOptions {
    /// Format: mt-manager, movella-dot, euroc, imu-tk, imucal, csv, mcap or parquet (default: by content).
    #[arg(long, value_parser = format)]
    format: Option<FileFormat>,
    /// Unit of the accelerometer, if the file does not state it: m/s2, g, mg or counts.
    #[arg(long, value_name = "UNIT", value_parser = accelerometer_unit)]
    accelerometer_unit: Option<ImuUnit>,
    /// Unit of the gyroscope, if the file does not state it: rad/s, deg/s, mdps or counts.
    #[arg(long, value_name = "UNIT", value_parser = gyroscope_unit)]
    gyroscope_unit: Option<ImuUnit>,
    /// Unit of the time column, if its name does not state it: s, ms, us or ns; samples for a counter.
    #[arg(long, value_name = "UNIT", value_parser = time_unit)]
    time_unit: Option<TimeUnit>,
    /// Sample rate, Hz, for files without sample times.
    #[arg(long, value_name = "HZ")]
    rate_hz: Option<f64>,
    /// Sample times: even, or as-logged (default: even, if the logged times are steps of a coarse clock about even ones).
    #[arg(long, value_name = "TIMES", value_parser = times)]
    times: Option<SampleTimes>,
    /// Topic of the IMU, in a bag with several IMUs.
    #[arg(long)]
    topic: Option<String>,
}

impl RecordingOptions {
    /// The options, as the readers take them.
    pub(crate) fn options(&self) -> ImuReadOptions {
        ImuReadOptions {
            format: self.format,
            time_unit: self.time_unit,
            accelerometer_unit: self.accelerometer_unit,
            gyroscope_unit: self.gyroscope_unit,
            rate_hz: self.rate_hz,
            times: self.times,
            topic: self.topic.clone(),
            budget: Some(budget()),
            ..ImuReadOptions::default()
        }
    }

    /// The same options, completed from `[columns]` of an experiment file.
    pub(crate) fn with_columns(&self, experiment: Option<&Path>) -> calibrant::Result<ImuReadOptions> {
        let given = self.options();
        let Some(experiment) = experiment else { return Ok(given) };
        Ok(given.or(read_columns(experiment)?))
    }
}

fn format(text: &str) -> Result<FileFormat, String> {
    let all = || FileFormat::ALL.map(FileFormat::name).join(", ");
    FileFormat::parse(text).ok_or_else(|| format!("the formats are {}", all()))
}

fn unit(text: &str, sensor_kind: SensorKind) -> Result<ImuUnit, String> {
    let choices = || format!("the {sensor_kind} is in {}", ImuUnit::choices(sensor_kind));
    ImuUnit::parse(text).filter(|unit| unit.suits(sensor_kind)).ok_or_else(choices)
}

fn accelerometer_unit(text: &str) -> Result<ImuUnit, String> {
    unit(text, SensorKind::Accelerometer)
}

fn gyroscope_unit(text: &str) -> Result<ImuUnit, String> {
    unit(text, SensorKind::Gyroscope)
}

/// A unit of readings, of either sensor.
pub(crate) fn any_unit(text: &str) -> Result<ImuUnit, String> {
    ImuUnit::parse(text).ok_or_else(|| {
        let [accelerometer, gyroscope] = SensorKind::ALL.map(ImuUnit::choices);
        format!("the accelerometer is in {accelerometer}, the gyroscope in {gyroscope}")
    })
}

fn time_unit(text: &str) -> Result<TimeUnit, String> {
    TimeUnit::parse(text).ok_or_else(|| "times are in s, ms, us or ns, or samples".into())
}

fn times(text: &str) -> Result<SampleTimes, String> {
    let found = SampleTimes::ALL.into_iter().find(|times| times.name() == text);
    found.ok_or_else(|| "sample times are even or as-logged".into())
}

/// A temperature that a sensor can have, °C.
pub(crate) fn celsius(text: &str) -> Result<f64, String> {
    let (low, high) = (WORKING_C.start(), WORKING_C.end());
    let value = text.parse().ok().filter(|value| WORKING_C.contains(value));
    value.ok_or_else(|| format!("a sensor's temperature in °C, from {low} to {high}"))
}
