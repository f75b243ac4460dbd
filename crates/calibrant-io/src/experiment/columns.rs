//! Reads `[columns]`: what a recording's file does not state itself.

use super::number_range::Bounds;
use super::toml_document::{Entry, Section};
use crate::{ColumnMapping, FileFormat, ImuReadOptions, ImuUnit, SampleTimes, TimeUnit};
use calibrant_core::error::Result;
use calibrant_core::sensor::SensorKind;

/// Range of a sample rate.
const RATE: Bounds = Bounds::from(1e-6, 1e9, "Hz");

/// Range of a sample rate's standard deviation.
const RATE_SD: Bounds = Bounds::from(0.0, 1e5, "ppm");

/// Reads `[columns]`.
pub(super) fn read(section: &Section<'_>) -> Result<ImuReadOptions> {
    let formats = FileFormat::ALL.map(|format| (format.name(), format));
    let times = [
        ("s", TimeUnit::Second),
        ("ms", TimeUnit::Millisecond),
        ("0.1 ms", TimeUnit::TenthMillisecond),
        ("us", TimeUnit::Microsecond),
        ("µs", TimeUnit::Microsecond),
        ("ns", TimeUnit::Nanosecond),
        ("samples", TimeUnit::Sample),
    ];
    let choices = SampleTimes::ALL.map(|times| (times.name(), times));
    let name = |key: &str| section.get(key).map(|entry| column(&entry)).transpose();
    let sensor_kind = |key: &str| section.get(key).map(|entry| three(&entry)).transpose();
    let columns = ColumnMapping {
        time: name("time")?,
        accelerometer: sensor_kind("accelerometer")?,
        gyroscope: sensor_kind("gyroscope")?,
        temperature: name("temperature")?,
    };
    no_column_twice(section, &columns)?;
    Ok(ImuReadOptions {
        format: section.get("format").map(|entry| entry.word(&formats)).transpose()?,
        time_unit: section.get("time_unit").map(|entry| entry.word(&times)).transpose()?,
        accelerometer_unit: unit(section, "accelerometer_unit", SensorKind::Accelerometer)?,
        gyroscope_unit: unit(section, "gyroscope_unit", SensorKind::Gyroscope)?,
        rate_hz: section.get("rate_hz").map(|entry| entry.number(&RATE)).transpose()?,
        rate_sd_ppm: section.get("rate_sd_ppm").map(|entry| entry.number(&RATE_SD)).transpose()?,
        topic: name("topic")?,
        times: section.get("times").map(|entry| entry.word(&choices)).transpose()?,
        columns,
        ..ImuReadOptions::default()
    })
}

fn column(entry: &Entry<'_>) -> Result<String> {
    /// The remedy for a wrong name of a column.
    const HELP: &str = "the name as it is in the file, in quotes; without a header, its number from \"1\"";
    match entry.text() {
        Some("") => Err(entry.reject("this name is empty", HELP)),
        Some(name) => Ok(name.to_owned()),
        None => Err(entry.wrong_type("a string", HELP)),
    }
}

fn three(entry: &Entry<'_>) -> Result<[String; 3]> {
    /// The remedy for a wrong list of columns.
    const HELP: &str = "the columns of x, y and z: [\"acc_x\", \"acc_y\", \"acc_z\"]";
    let names = entry.items(HELP)?.iter().map(column).collect::<Result<Vec<_>>>()?;
    let count = names.len();
    names.try_into().map_err(|_| entry.reject(format!("{count} columns for 3 axes"), HELP))
}

fn unit(section: &Section<'_>, key: &str, sensor_kind: SensorKind) -> Result<Option<ImuUnit>> {
    let Some(entry) = section.get(key) else { return Ok(None) };
    if let Some(unit) = entry.text().and_then(ImuUnit::parse).filter(|unit| unit.suits(sensor_kind)) {
        return Ok(Some(unit));
    }
    let words: Vec<(&str, ImuUnit)> = ImuUnit::ALL
        .into_iter()
        .filter(|unit| unit.suits(sensor_kind))
        .map(|unit| (unit.symbol(), unit))
        .collect();
    entry.word(&words).map(Some)
}

fn no_column_twice(section: &Section<'_>, columns: &ColumnMapping) -> Result<()> {
    let mut seen: Vec<&str> = Vec::new();
    let sensor_kinds = SensorKind::ALL.into_iter().flat_map(|sensor_kind| {
        columns.sensor(sensor_kind).into_iter().flatten().map(move |name| (sensor_kind.name(), name))
    });
    let singles = [("time", &columns.time), ("temperature", &columns.temperature)];
    let singles = singles.into_iter().filter_map(|(key, name)| Some((key, name.as_ref()?)));
    for (key, name) in singles.chain(sensor_kinds) {
        if seen.contains(&name.as_str()) {
            let message = format!("the column `{name}` is named twice");
            return Err(section.get(key).map_or_else(
                || section.reject(&message, "", key),
                |entry| entry.reject(message.clone(), "each column holds one thing"),
            ));
        }
        seen.push(name);
    }
    Ok(())
}
