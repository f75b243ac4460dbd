//! Text of imu_tk: `t x y z` without a header, seconds and readings. Accelerometer and gyroscope each have a
//! file of their own.

use super::column::{ColumnMeaning, ImuColumn};
use super::file_layout::Draft;
use super::first_rows::FirstRows;
use super::format::{FileFormat, LEAVE_AWAY};
use super::headerless_text;
use super::names_of_file::columns;
use super::options::ImuReadOptions;
use super::unit::ColumnUnit;
use crate::recording::clock_column::median_step;
use crate::recording::text_header::Head;
use crate::recording::time_unit::TimeUnit;
use crate::text::decoding::Checked;
use calibrant_core::error::{InputError, Refusal};
use calibrant_core::sensor::{Axis, SensorKind};

/// The columns of one of the two files; `sensor_kind` is its sensor, where that is known.
pub(super) fn draft(
    head: &Head<'_>,
    sensor_kind: Option<SensorKind>,
    options: &ImuReadOptions,
) -> Checked<Draft> {
    let columns = in_order(head, sensor_kind.unwrap_or(SensorKind::Accelerometer), 3, options)?;
    if !head.names.is_empty() && sensor_kind.is_none() {
        return Err(InputError::new(
            Refusal::FormatContradicted,
            "imu_tk's files have no header, and this one has",
            LEAVE_AWAY,
        )
        .at_line(head.line())
        .into());
    }
    if sensor_kind.is_none() {
        return Err(InputError::new(Refusal::SensorUnnamed,
            "imu_tk keeps each sensor in a file of its own, t x y z: this one does not say which it is",
            format!(
                "give the accelerometer's file as the recording, the gyroscope's with option `gyroscope`, and their units with option `accelerometer_unit` and option `gyroscope_unit`; \
                 or {}",
                headerless_text::in_columns(head).unwrap_or_default()
            ),
        )
        .at_line(head.line())
        .into());
    }
    Ok(Draft::new(FileFormat::ImuTk, columns))
}

/// Means of the accelerometer: `x y z`, a row for each hold.
pub(super) fn means() -> Draft {
    let column = |axis: Axis| {
        let meaning = ColumnMeaning::Reading(SensorKind::Accelerometer, axis);
        ImuColumn::new(&(axis.index() + 1).to_string(), meaning, None)
    };
    Draft::new(FileFormat::Csv, Axis::ALL.map(column).to_vec())
}

/// The columns of a text without a header in their order: `t x y z`, or fewer axes. Times are in seconds, where nobody says another unit and their steps may be.
pub(super) fn in_order(
    head: &Head<'_>,
    sensor_kind: SensorKind,
    axes: usize,
    options: &ImuReadOptions,
) -> Checked<Vec<ImuColumn>> {
    let (columns, needed) = (head.fields(), axes + 1);
    if columns < needed {
        let message =
            format!("{columns} column{} where {needed} are needed", if columns == 1 { "" } else { "s" });
        let order = if axes == 1 { "t x" } else { "t x y z" };
        let in_columns = headerless_text::in_columns(head);
        let means = match columns {
            3 if sensor_kind == SensorKind::Accelerometer => {
                "; where each row is the mean of a hold, say option `rows_are_holds`"
            }
            _ => "",
        };
        let help = format!(
            "without a header the columns are {order}{means}{}",
            in_columns.map_or_else(String::new, |stated| format!("; or {stated}"))
        );
        return Err(InputError::new(Refusal::ColumnMissing, message, help).at_line(head.line()).into());
    }
    let seconds = in_seconds(head, options);
    let of_order = |column: usize| match column {
        0 => ImuColumn::new("1", ColumnMeaning::Time, seconds),
        1..=3 => {
            let meaning = ColumnMeaning::Reading(sensor_kind, Axis::ALL[column - 1]);
            ImuColumn::new(&(column + 1).to_string(), meaning, None)
        }
        _ => ImuColumn::new(&(column + 1).to_string(), ColumnMeaning::Other, None),
    };
    Ok((0..columns).map(of_order).collect())
}

/// The columns of a file with a header that holds this sensor: `t_s,x,y,z`, or names that include the sensor.
pub(super) fn named(head: &Head<'_>, sensor_kind: SensorKind) -> Vec<ImuColumn> {
    let of_sensor = |column: ImuColumn| {
        let axis = ["x", "y", "z"].iter().position(|axis| column.name.eq_ignore_ascii_case(axis));
        let meaning = axis.map(|k| ColumnMeaning::Reading(sensor_kind, Axis::ALL[k]));
        match meaning.filter(|_| column.meaning == ColumnMeaning::Other) {
            Some(meaning) => ImuColumn::new(&column.name, meaning, None),
            None => column,
        }
    };
    columns(head).into_iter().map(of_sensor).collect()
}

/// Seconds, for the first column of a text without names. `None` where the user gives a unit, or where the samples would be seconds apart.
pub(super) fn in_seconds(head: &Head<'_>, options: &ImuReadOptions) -> Option<ColumnUnit> {
    /// Longest step between samples, s.
    const LONGEST_S: f64 = 0.9;
    let rows = FirstRows::of(head);
    let is_far = rows.are_enough() && median_step(&rows.times(0)).is_some_and(|step| step > LONGEST_S);
    (options.time_unit.is_none() && !is_far).then_some(ColumnUnit::Time(TimeUnit::Second))
}
