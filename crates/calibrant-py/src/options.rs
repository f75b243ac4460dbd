//! Options of a call, which come as JSON.

use crate::failure::invalid;
use calibrant::Result;
use calibrant::budget::Budget;
use calibrant::diagnostic::Code;
use calibrant::io::{
    ColumnMapping, FileFormat, ImuReadOptions, ImuUnit, NamePattern, SampleTimes, SensorNaming, TimeUnit,
    nearest, read_acceptance,
};
use calibrant::sensor::SensorKind;
use calibrant::session::SessionOptions;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// Reads options.
pub(crate) fn parsed<T: DeserializeOwned>(text: &str) -> Result<T> {
    serde_json::from_str(text).map_err(|error| {
        let why = error.to_string();
        let why = why.split(" at line ").next().unwrap_or_default();
        // every option has a default: the one that fails alone is at fault
        let options = serde_json::from_str::<Map<String, Value>>(text).unwrap_or_default();
        let fails =
            |(name, value): &(String, Value)| serde_json::from_value::<T>(json!({ name: value })).is_err();
        let message = match options.into_iter().find(fails) {
            Some((name, _)) => format!("`{name}`: {why}"),
            None => format!("an argument makes no sense: {why}"),
        };
        invalid(message, "see the documentation of the function")
    })
}

/// The budget of work: the usual, or none.
pub(crate) fn budget(force: bool) -> Budget {
    if force { Budget::UNLIMITED } else { Budget::USUAL }
}

/// What a file of a recording does not state itself.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Reading {
    format: Option<String>,
    columns: Columns,
    time_unit: Option<String>,
    accelerometer_unit: Option<String>,
    gyroscope_unit: Option<String>,
    rate_hz: Option<f64>,
    rate_sd_ppm: Option<f64>,
    instance: Option<String>,
    times: Option<String>,
    topic: Option<String>,
    rows_are_holds: bool,
    force: bool,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Columns {
    time: Option<TimeColumns>,
    accelerometer: Option<[String; 3]>,
    gyroscope: Option<[String; 3]>,
    temperature: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(untagged, expecting = "the name of a column, or [whole seconds, rest of the second]")]
enum TimeColumns {
    One(String),
    Two([String; 2]),
}

impl Reading {
    /// As the library takes it.
    pub(crate) fn options(&self) -> Result<ImuReadOptions> {
        let unit = |name: &str, text: &Option<String>, sensor_kind: SensorKind| {
            let choices = || format!("the {sensor_kind} is in {}", ImuUnit::choices(sensor_kind));
            let read = |text: &str| ImuUnit::parse(text).filter(|unit| unit.suits(sensor_kind));
            chosen(name, text, read, choices)
        };
        let of = self.columns.clone();
        let (time, rest_of_second) = match of.time {
            None => (None, None),
            Some(TimeColumns::One(time)) => (Some(time), None),
            Some(TimeColumns::Two([seconds, rest])) => (Some(seconds), Some(rest)),
        };
        Ok(ImuReadOptions {
            format: chosen("format", &self.format, FileFormat::parse, || {
                format!("the formats are {}", FileFormat::ALL.map(FileFormat::name).join(", "))
            })?,
            columns: ColumnMapping {
                time,
                rest_of_second,
                accelerometer: of.accelerometer,
                gyroscope: of.gyroscope,
                temperature: of.temperature,
            },
            time_unit: time_unit(&self.time_unit)?,
            accelerometer_unit: unit(
                "accelerometer_unit",
                &self.accelerometer_unit,
                SensorKind::Accelerometer,
            )?,
            gyroscope_unit: unit("gyroscope_unit", &self.gyroscope_unit, SensorKind::Gyroscope)?,
            rate_hz: positive("rate_hz", self.rate_hz)?,
            rate_sd_ppm: self.rate_sd_ppm,
            instance: self.instance.clone(),
            times: chosen(
                "times",
                &self.times,
                |text| SampleTimes::ALL.into_iter().find(|times| times.name() == text),
                || "sample times are even or as-logged".into(),
            )?,
            topic: self.topic.clone(),
            rows_are_holds: self.rows_are_holds,
            budget: Some(budget(self.force)),
            ..ImuReadOptions::default()
        })
    }
}

/// A number above 0, where it is there.
pub(crate) fn positive(name: &str, value: Option<f64>) -> Result<Option<f64>> {
    match value {
        Some(value) if !value.is_finite() || value <= 0.0 => {
            Err(invalid(format!("`{name}` is {value}"), "give a number above 0"))
        }
        value => Ok(value),
    }
}

/// The unit of times.
pub(crate) fn time_unit(name: &Option<String>) -> Result<Option<TimeUnit>> {
    chosen("time_unit", name, TimeUnit::parse, || "times are in s, ms, us or ns, or samples".into())
}

/// The choice that a text names.
fn chosen<T>(
    name: &str,
    text: &Option<String>,
    read: impl Fn(&str) -> Option<T>,
    choices: impl Fn() -> String,
) -> Result<Option<T>> {
    let refused = |text: &String| invalid(format!("`{name}` is {text:?}"), choices());
    text.as_ref().map(|text| read(text).ok_or_else(|| refused(text))).transpose()
}

/// What is said of a calibration beside experiment, recordings and motion.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Calibrate {
    experiment_file: PathBuf,
    reading: Reading,
    folds: Option<usize>,
    accept: Option<PathBuf>,
    allow: Vec<String>,
    sensor: Option<String>,
    sensor_from: Option<String>,
    sensor_key: Option<String>,
    station: Option<String>,
    report: bool,
}

impl Calibrate {
    /// As the library takes it.
    pub(crate) fn options(&self) -> Result<SessionOptions> {
        let code = |name: &String| {
            Code::parse(name).ok_or_else(|| {
                let near = nearest(name, Code::all().map(Code::name));
                let help = near.map_or_else(
                    || "see docs/diagnostics.md".to_owned(),
                    |near| format!("did you mean {near:?}?"),
                );
                invalid(format!("`allow` has {name:?}, which is no diagnostic"), help)
            })
        };
        Ok(SessionOptions {
            experiment_file: self.experiment_file.clone(),
            reading: self.reading.options()?,
            folds: self.folds,
            accept: self.accept.as_deref().map(read_acceptance).transpose()?,
            allowed: self.allow.iter().map(code).collect::<Result<_>>()?,
            naming: SensorNaming {
                sensor: self.sensor.clone(),
                key: self.sensor_key.clone(),
                pattern: self.sensor_from.as_deref().map(NamePattern::parse).transpose()?,
                station: self.station.clone(),
            },
            report: self.report,
            ..SessionOptions::default()
        })
    }
}
