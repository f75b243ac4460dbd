//! The column names that Xsens' and Movella's programs share. Units and ticks differ between them: see [`mt_manager`](super::mt_manager) and
//! [`movella_dot`](super::movella_dot).

use super::column::{ColumnMeaning, ImuColumn};
use super::unit::{ColumnUnit, ImuUnit};
use crate::recording::time_unit::TimeUnit;
use calibrant_core::sensor::{Axis, SensorKind};

/// Columns of these names.
pub(super) fn columns(names: &[&str], gyroscope: ImuUnit, ticks: TimeUnit) -> Vec<ImuColumn> {
    names
        .iter()
        .map(|name| {
            let meaning = meaning(name);
            let unit = match meaning {
                ColumnMeaning::Time => Some(ColumnUnit::Time(ticks)),
                ColumnMeaning::Counter => Some(ColumnUnit::Time(TimeUnit::Sample)),
                ColumnMeaning::Reading(SensorKind::Accelerometer, _) | ColumnMeaning::GravityRemoved => {
                    Some(ColumnUnit::Reading(ImuUnit::MetrePerSecondSquared))
                }
                ColumnMeaning::Reading(SensorKind::Gyroscope, _) => Some(ColumnUnit::Reading(gyroscope)),
                ColumnMeaning::Temperature => Some(ColumnUnit::Celsius),
                _ => None,
            };
            ImuColumn::new(name, meaning, unit)
        })
        .collect()
}

fn meaning(name: &str) -> ColumnMeaning {
    let name = name.to_lowercase();
    let axis = |sensor_kind, letter: &str| {
        ["x", "y", "z"]
            .iter()
            .position(|axis| *axis == letter)
            .map_or(ColumnMeaning::Other, |k| ColumnMeaning::Reading(sensor_kind, Axis::ALL[k]))
    };
    let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| name.starts_with(prefix));
    match name.as_str() {
        "packetcounter" => ColumnMeaning::Counter,
        "sampletimefine" => ColumnMeaning::Time,
        "temperature" => ColumnMeaning::Temperature,
        "roll" | "pitch" | "yaw" => ColumnMeaning::Orientation,
        "year" | "month" | "day" | "hour" | "minute" | "second" => ColumnMeaning::Calendar,
        name if name.starts_with("acc_") => axis(SensorKind::Accelerometer, &name[4..]),
        name if name.starts_with("gyr_") => axis(SensorKind::Gyroscope, &name[4..]),
        _ if starts(&["freeacc"]) => ColumnMeaning::GravityRemoved,
        _ if starts(&["mat[", "quat_", "euler_", "roll_", "pitch_", "yaw_"]) => ColumnMeaning::Orientation,
        _ if starts(&["velinc_", "oriinc_", "dv[", "dq_"]) => ColumnMeaning::Increment,
        _ if starts(&["mag_"]) => ColumnMeaning::Magnetometer,
        _ if starts(&["utc_"]) => ColumnMeaning::Calendar,
        _ => ColumnMeaning::Other,
    }
}
