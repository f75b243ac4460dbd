//! The options of all commands that read a recording. They state what its file does not.

use crate::budget::budget;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{FileFormat, ImuReadOptions, ImuUnit, RawUnits, SampleTimes, TimeUnit, read_columns};
use calibrant::sensor::{SensorKind, WORKING_C};
use std::path::Path;

#[derive(clap::Args, Clone)]
pub(crate) struct RecordingOptions {
    /// Format: mt-manager, movella-dot, euroc, imu-tk, imucal, csv, mcap, db3, rosbag, parquet, ulog or dataflash (default: by content).
    #[arg(long, value_parser = format)]
    format: Option<FileFormat>,
    /// Unit of the readings, if the file does not state it: m/s2, mm/s2, g or mg of the accelerometer, rad/s, deg/s or mdps of the gyroscope, counts of both.
    #[arg(long, value_parser = any_unit)]
    unit: Option<ImuUnit>,
    /// Unit of the accelerometer, if the file does not state it: m/s2, mm/s2, g, mg or counts.
    #[arg(long, value_name = "UNIT", value_parser = accelerometer_unit)]
    accelerometer_unit: Option<ImuUnit>,
    /// Unit of the gyroscope, if the file does not state it: rad/s, deg/s, mdps or counts.
    #[arg(long, value_name = "UNIT", value_parser = gyroscope_unit)]
    gyroscope_unit: Option<ImuUnit>,
    /// Sensitivity of the accelerometer, if its readings are counts: they are calibrated in m/s² then. Other units: --accelerometer-unit "0.061 mg/LSB".
    #[arg(long, value_name = "COUNTS", conflicts_with_all = ["unit", "accelerometer_unit"])]
    accelerometer_lsb_per_g: Option<f64>,
    /// Sensitivity of the gyroscope, if its readings are counts: they are calibrated in rad/s then. Other units: --gyroscope-unit "8.75 mdps/LSB".
    #[arg(long, value_name = "COUNTS", conflicts_with_all = ["unit", "gyroscope_unit"])]
    gyroscope_lsb_per_dps: Option<f64>,
    /// Unit of the time column, if its name does not state it: s, ms, us or ns; samples for a counter.
    #[arg(long, value_name = "UNIT", value_parser = time_unit)]
    time_unit: Option<TimeUnit>,
    /// Sample rate, Hz, for files without sample times.
    #[arg(long, value_name = "HZ")]
    rate_hz: Option<f64>,
    /// Standard deviation of that rate, ppm (default: 50000, 5 per cent, of a rate that is typed; 100 of one that a logger states).
    #[arg(long, value_name = "PPM", value_parser = ppm)]
    rate_sd_ppm: Option<f64>,
    /// Which sensor to read, if a file has those of several: its value in the column that numbers them, or its number in the log of an autopilot.
    #[arg(long, value_name = "VALUE")]
    instance: Option<String>,
    /// Sample times: even, or as-logged (default: even, if the logged times are steps of a coarse clock about even ones).
    #[arg(long, value_name = "TIMES", value_parser = times)]
    times: Option<SampleTimes>,
    /// Each row is the mean of a hold: a table of averages, without times.
    #[arg(long)]
    rows_are_holds: bool,
    /// Topic of the IMU, in a bag with several IMUs or in the log of an autopilot.
    #[arg(long)]
    topic: Option<String>,
}

impl RecordingOptions {
    /// The options, as the readers take them. --unit is that of each sensor that can have it.
    pub(crate) fn options(&self) -> calibrant::Result<ImuReadOptions> {
        SensorKind::ALL.into_iter().try_fold(self.plain()?, |options, sensor_kind| match self.unit {
            Some(unit) if unit.suits(sensor_kind) => with_unit(options, sensor_kind, unit),
            _ => Ok(options),
        })
    }

    /// What --unit says of a calibration of such readings.
    pub(crate) fn raw_units(&self) -> Option<RawUnits> {
        self.unit.map(|unit| if unit == ImuUnit::Counts { RawUnits::Counts } else { RawUnits::Si })
    }

    /// The same, for the readings of this sensor: --unit must be one of its units, and says nothing of the other sensor.
    pub(crate) fn options_of(&self, sensor_kind: SensorKind) -> calibrant::Result<ImuReadOptions> {
        let Some(unit) = self.unit else { return self.plain() };
        if !unit.suits(sensor_kind) {
            let message = format!("--unit {} is no unit of the {sensor_kind}", unit.symbol());
            return Err(usage(&message, &format!("its readings are in {}", ImuUnit::choices(sensor_kind))));
        }
        with_unit(self.plain()?, sensor_kind, unit)
    }

    /// The options but --unit.
    fn plain(&self) -> calibrant::Result<ImuReadOptions> {
        Ok(ImuReadOptions {
            format: self.format,
            time_unit: self.time_unit,
            accelerometer_unit: self
                .accelerometer_unit
                .or(sensitivity(self.accelerometer_lsb_per_g, ImuUnit::StandardGravity)?),
            gyroscope_unit: self
                .gyroscope_unit
                .or(sensitivity(self.gyroscope_lsb_per_dps, ImuUnit::DegreePerSecond)?),
            rate_hz: self.rate_hz,
            rate_sd_ppm: self.rate_sd_ppm,
            instance: self.instance.clone(),
            times: self.times,
            topic: self.topic.clone(),
            rows_are_holds: self.rows_are_holds,
            budget: Some(budget()),
            ..ImuReadOptions::default()
        })
    }

    /// The same options, completed from `[columns]` of an experiment file.
    pub(crate) fn with_columns(&self, experiment: Option<&Path>) -> calibrant::Result<ImuReadOptions> {
        completed(self.options()?, experiment)
    }
}

/// Counts of this sensitivity, where it is given.
fn sensitivity(counts: Option<f64>, per: ImuUnit) -> calibrant::Result<Option<ImuUnit>> {
    let none = |counts: f64| {
        let message = format!("{counts} LSB per {} is no sensitivity", per.symbol());
        usage(&message, "give the number of the datasheet, for the range in which it was recorded")
    };
    counts.map(|counts| ImuUnit::of_counts(counts, per).ok_or_else(|| none(counts))).transpose()
}

/// Options, completed from `[columns]` of an experiment file.
pub(crate) fn completed(
    given: ImuReadOptions,
    experiment: Option<&Path>,
) -> calibrant::Result<ImuReadOptions> {
    let Some(experiment) = experiment else { return Ok(given) };
    Ok(given.or(read_columns(experiment)?))
}

/// The options with --unit, which must not contradict the option of the sensor.
fn with_unit(
    options: ImuReadOptions,
    sensor_kind: SensorKind,
    unit: ImuUnit,
) -> calibrant::Result<ImuReadOptions> {
    match options.unit(sensor_kind).filter(|other| *other != unit) {
        Some(other) => {
            let (unit, other) = (unit.symbol(), other.symbol());
            let message = format!("--unit is {unit}, but the {sensor_kind}'s unit is given as {other}");
            Err(usage(&message, "omit one of them"))
        }
        None => Ok(options.with_unit(sensor_kind, Some(unit))),
    }
}

fn usage(message: &str, help: &str) -> Error {
    Error::experiment(InputError::new(Refusal::UnitContradicted, message, help))
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
fn any_unit(text: &str) -> Result<ImuUnit, String> {
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

fn ppm(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| (0.0..=1e5).contains(value));
    value.ok_or_else(|| "a standard deviation in ppm, from 0 to 100000".into())
}

/// A temperature that a sensor can have, °C.
pub(crate) fn celsius(text: &str) -> Result<f64, String> {
    let (low, high) = (WORKING_C.start(), WORKING_C.end());
    let value = text.parse().ok().filter(|value| WORKING_C.contains(value));
    value.ok_or_else(|| format!("a sensor's temperature in °C, from {low} to {high}"))
}
