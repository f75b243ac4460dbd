//! `[columns]`: what a recording's file does not state itself.

use super::fault::unknown_word;
use super::number::Within;
use super::ranges::{AccelerometerGain, FileRate, GyroscopeGain, RateSd, SensitivityPerDps, SensitivityPerG};
use super::refused_key::refused;
use super::remedies::{COLUMN, remedy};
use calibrant_core::error::Result;
use calibrant_core::sensor::SensorKind;
use calibrant_recording::{ColumnMapping, FileFormat, ImuReadOptions, ImuUnit, SampleTimes, TimeUnit};
use serde::{Deserialize, Serialize};

/// `[columns]`: what a recording's file does not state itself.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColumnsSection {
    /// The format.
    pub format: Option<FileFormat>,
    /// Name of the column of times, or of the two of whole seconds and of what is to be added.
    pub time: Option<TimeColumns>,
    /// Unit of the times.
    pub time_unit: Option<TimeUnit>,
    /// Even times, or the logged ones.
    pub times: Option<SampleTimes>,
    /// Sample rate, for files without times.
    pub rate_hz: Option<Within<FileRate>>,
    /// Standard deviation of that rate.
    pub rate_sd_ppm: Option<Within<RateSd>>,
    /// Names of the columns of the accelerometer, x to z.
    pub accelerometer: Option<Vec<String>>,
    /// Their unit.
    pub accelerometer_unit: Option<String>,
    /// Names of the columns of the gyroscope, x to z.
    pub gyroscope: Option<Vec<String>>,
    /// Their unit.
    pub gyroscope_unit: Option<String>,
    /// Sensitivity of the accelerometer's counts, per g.
    pub accelerometer_lsb_per_g: Option<Within<SensitivityPerG>>,
    /// The same per m/s².
    pub accelerometer_lsb_per_mps2: Option<Within<AccelerometerGain>>,
    /// Sensitivity of the gyroscope's counts, per deg/s.
    pub gyroscope_lsb_per_dps: Option<Within<SensitivityPerDps>>,
    /// The same per rad/s.
    pub gyroscope_lsb_per_radps: Option<Within<GyroscopeGain>>,
    /// Name of the column of temperatures.
    pub temperature: Option<String>,
    /// Which sensor, of a file with the rows of several.
    pub instance: Option<String>,
    /// Topic of a bag with several.
    pub topic: Option<String>,
}

/// The columns of times.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "the name of a column, or [whole seconds, rest of the second]")]
pub enum TimeColumns {
    /// One of times.
    One(String),
    /// Whole seconds, and what is to be added.
    Two([String; 2]),
}

impl TimeColumns {
    fn names(&self) -> [Option<&String>; 2] {
        match self {
            Self::One(time) => [Some(time), None],
            Self::Two([seconds, rest]) => [Some(seconds), Some(rest)],
        }
    }
}

impl ColumnsSection {
    /// The options of a reader.
    pub(super) fn options(&self) -> Result<ImuReadOptions> {
        let [time, rest_of_second] = self.time.as_ref().map_or([None, None], TimeColumns::names);
        let columns = ColumnMapping {
            time: column("columns.time", time)?,
            rest_of_second: column("columns.time", rest_of_second)?,
            accelerometer: three("columns.accelerometer", self.accelerometer.as_ref())?,
            gyroscope: three("columns.gyroscope", self.gyroscope.as_ref())?,
            temperature: column("columns.temperature", self.temperature.as_ref())?,
        };
        no_column_twice(&columns)?;
        Ok(ImuReadOptions {
            format: self.format,
            time_unit: self.time_unit,
            accelerometer_unit: unit(
                ("columns.accelerometer_unit", self.accelerometer_unit.as_ref(), SensorKind::Accelerometer),
                [
                    (
                        "columns.accelerometer_lsb_per_g",
                        self.accelerometer_lsb_per_g.map(f64::from),
                        ImuUnit::StandardGravity,
                    ),
                    (
                        "columns.accelerometer_lsb_per_mps2",
                        self.accelerometer_lsb_per_mps2.map(f64::from),
                        ImuUnit::MetrePerSecondSquared,
                    ),
                ],
            )?,
            gyroscope_unit: unit(
                ("columns.gyroscope_unit", self.gyroscope_unit.as_ref(), SensorKind::Gyroscope),
                [
                    (
                        "columns.gyroscope_lsb_per_dps",
                        self.gyroscope_lsb_per_dps.map(f64::from),
                        ImuUnit::DegreePerSecond,
                    ),
                    (
                        "columns.gyroscope_lsb_per_radps",
                        self.gyroscope_lsb_per_radps.map(f64::from),
                        ImuUnit::RadianPerSecond,
                    ),
                ],
            )?,
            rate_hz: self.rate_hz.map(f64::from),
            rate_sd_ppm: self.rate_sd_ppm.map(f64::from),
            instance: column("columns.instance", self.instance.as_ref())?,
            topic: column("columns.topic", self.topic.as_ref())?,
            times: self.times,
            columns,
            ..ImuReadOptions::default()
        })
    }
}

fn column(key: &str, name: Option<&String>) -> Result<Option<String>> {
    match name {
        Some(name) if name.is_empty() => Err(refused(key, "this name is empty", COLUMN)),
        name => Ok(name.cloned()),
    }
}

fn three(key: &str, names: Option<&Vec<String>>) -> Result<Option<[String; 3]>> {
    let Some(names) = names else { return Ok(None) };
    let count = names.len();
    for (number, name) in names.iter().enumerate() {
        column(&format!("{key}[{number}]"), Some(name))?;
    }
    let three = names.clone().try_into();
    three.map(Some).map_err(|_| refused(key, format!("{count} columns for 3 axes"), remedy(key)))
}

/// The unit of a sensor's columns: by its name, or counts of a sensitivity.
fn unit(
    (key, text, sensor_kind): (&str, Option<&String>, SensorKind),
    sensitivities: [(&str, Option<f64>, ImuUnit); 2],
) -> Result<Option<ImuUnit>> {
    let named = text.map(|text| unit_named(key, text, sensor_kind)).transpose()?;
    let mut given = named.filter(|unit| *unit != ImuUnit::Counts).map(|unit| (key, unit));
    for (key, counts, per) in sensitivities {
        let Some(unit) = counts.and_then(|counts| ImuUnit::of_counts(counts, per)) else { continue };
        if let Some((other, _)) = given.replace((key, unit)) {
            return Err(refused(
                key,
                format!("`{other}` says the unit of the same columns"),
                "keep one of the two",
            ));
        }
    }
    Ok(given.map(|(_, unit)| unit).or(named))
}

fn unit_named(key: &str, text: &str, sensor_kind: SensorKind) -> Result<ImuUnit> {
    if let Some(unit) = ImuUnit::parse(text).filter(|unit| unit.suits(sensor_kind)) {
        return Ok(unit);
    }
    let suited = ImuUnit::ALL.into_iter().filter(|unit| unit.suits(sensor_kind));
    let words: Vec<&str> = suited.map(ImuUnit::symbol).collect();
    let said = unknown_word(text, &words);
    let (message, help) = said.split_once('\n').unwrap_or((&said, ""));
    let also = "; or counts of a sensitivity: \"16384 LSB/g\", \"8.75 mdps/LSB\"";
    Err(refused(key, message, format!("{help}{also}")))
}

fn no_column_twice(columns: &ColumnMapping) -> Result<()> {
    let mut seen: Vec<&str> = Vec::new();
    // rows of one sensor each share their columns
    let are_shared = columns.accelerometer == columns.gyroscope;
    let own = SensorKind::ALL.into_iter().take(if are_shared { 1 } else { 2 });
    let sensor_kinds = own.flat_map(|sensor_kind| {
        columns.sensor(sensor_kind).into_iter().flatten().map(move |name| (sensor_kind.name(), name))
    });
    let singles =
        [("time", &columns.time), ("time", &columns.rest_of_second), ("temperature", &columns.temperature)];
    let singles = singles.into_iter().filter_map(|(key, name)| Some((key, name.as_ref()?)));
    for (key, name) in singles.chain(sensor_kinds) {
        if seen.contains(&name.as_str()) {
            let message = format!("the column `{name}` is named twice");
            return Err(refused(format!("columns.{key}"), message, "each column holds one thing"));
        }
        seen.push(name);
    }
    Ok(())
}
