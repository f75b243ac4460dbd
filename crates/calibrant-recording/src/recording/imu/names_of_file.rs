//! The meaning of the columns of a file, from all of its names: units in a row below them, a word that they share, and what stands beside them.

use super::column::{ColumnMeaning, ImuColumn};
use super::column_names::{column, is_plain_axis};
use super::unit::{ColumnUnit, ImuUnit};
use crate::recording::text_header::Head;
use crate::recording::time_unit::TimeUnit;
use calibrant_core::sensor::SensorKind;

/// The columns that Kalibr writes and reads, whose units its format defines.
const OF_KALIBR: [&str; 7] = ["timestamp", "omega_x", "omega_y", "omega_z", "alpha_x", "alpha_y", "alpha_z"];

/// The columns of a header.
pub(super) fn columns(head: &Head<'_>) -> Vec<ImuColumn> {
    if head.names == OF_KALIBR {
        return kalibr();
    }
    let prefix = shared_prefix(&head.names);
    let mut found: Vec<ImuColumn> =
        (0..head.names.len()).map(|k| of_name(head.names[k], head.units.get(k), prefix)).collect();
    // of several stamps the sensor's own
    let is_own = |column: &ImuColumn| prefix.is_some_and(|prefix| column.name.starts_with(prefix));
    if found.iter().any(|column| is_time(column) && is_own(column)) {
        for other in found.iter_mut().filter(|column| is_time(column) && !is_own(column)) {
            *other = ImuColumn::new(&other.name, ColumnMeaning::Clock, other.unit);
        }
    }
    beside_an_accelerometer(&mut found);
    found
}

fn of_name(name: &str, unit: Option<&&str>, prefix: Option<&str>) -> ImuColumn {
    let own = prefix.and_then(|prefix| name.strip_prefix(prefix)).unwrap_or(name);
    let plain = column(own);
    let found = match unit {
        Some(unit) if plain.unit.is_none() => column(&format!("{own} [{unit}]")),
        _ => plain,
    };
    ImuColumn { name: name.to_owned(), ..found }
}

/// The word before the names of both sensors' columns, as `field.` in `field.linear_acceleration.x`. `None` where they are known without, or are several.
fn shared_prefix<'n>(names: &[&'n str]) -> Option<&'n str> {
    let is_reading = |name: &str| match column(name).meaning {
        ColumnMeaning::Reading(sensor_kind, axis) => Some((sensor_kind, axis)),
        _ => None,
    };
    if names.iter().any(|name| is_reading(name).is_some()) {
        return None;
    }
    let prefixes =
        names.iter().flat_map(|name| name.match_indices(['.', '/', '_', ' ']).map(|(at, _)| &name[..=at]));
    let mut tried: Vec<&str> = Vec::new();
    let mut found = prefixes.filter(|prefix| {
        let is_new = !tried.contains(prefix);
        tried.push(prefix);
        let mut readings: Vec<_> =
            names.iter().filter_map(|name| is_reading(name.strip_prefix(*prefix)?)).collect();
        readings.dedup();
        is_new && readings.len() == 6
    });
    found.next().filter(|_| found.next().is_none())
}

/// `g_x` may be gravity; beside `a_x` it is a gyroscope's.
fn beside_an_accelerometer(columns: &mut [ImuColumn]) {
    let lower = |column: &ImuColumn| column.name.to_lowercase();
    let has = |start: &str| columns.iter().filter(|column| lower(column).starts_with(start)).count() == 3;
    if !(has("a_") && has("g_")) {
        return;
    }
    for found in columns.iter_mut().filter(|column| lower(column).starts_with("g_")) {
        let renamed = column(&format!("gyro_{}", &found.name[2..]));
        *found = ImuColumn { name: found.name.clone(), ..renamed };
    }
}

fn kalibr() -> Vec<ImuColumn> {
    let unit = |sensor_kind| match sensor_kind {
        SensorKind::Accelerometer => ImuUnit::MetrePerSecondSquared,
        SensorKind::Gyroscope => ImuUnit::RadianPerSecond,
    };
    let of_name = |name: &&str| {
        let meaning = column(&name.replace("alpha", "a").replace("omega", "w")).meaning;
        let unit = match meaning {
            ColumnMeaning::Reading(sensor_kind, _) => ColumnUnit::Reading(unit(sensor_kind)),
            _ => ColumnUnit::Time(TimeUnit::Nanosecond),
        };
        ImuColumn::new(name, meaning, Some(unit))
    };
    OF_KALIBR.iter().map(of_name).collect()
}

/// Is it a column of a reading?
pub(super) fn is_reading(column: &ImuColumn) -> bool {
    matches!(column.meaning, ColumnMeaning::Reading(..))
}

fn is_time(column: &ImuColumn) -> bool {
    column.meaning == ColumnMeaning::Time
}

/// Are they the columns of one unnamed sensor, beside nothing but times? Loggers of one sensor call any of
/// them ax, ay, az.
pub(super) fn are_unnamed(columns: &[ImuColumn]) -> bool {
    let may_be_another = |column: &ImuColumn| match column.unit {
        None | Some(ColumnUnit::Reading(ImuUnit::Counts)) => is_plain_axis(&column.name),
        _ => false,
    };
    columns.iter().all(|column| match column.meaning {
        ColumnMeaning::Reading(..) => may_be_another(column),
        ColumnMeaning::Time | ColumnMeaning::Counter => true,
        _ => false,
    })
}
