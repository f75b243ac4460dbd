//! Text of imu_tk: `t x y z` without a header, seconds and readings. Accelerometer and gyroscope each have a
//! file of their own.

use super::column::{ColumnMeaning, ImuColumn};
use super::file_layout::Draft;
use super::format::{FileFormat, LEAVE_AWAY};
use super::unit::ColumnUnit;
use super::{column_names, headerless_text};
use crate::recording::text_header::Head;
use crate::recording::time_unit::TimeUnit;
use crate::text::decoding::Checked;
use calibrant_core::error::{InputError, Refusal};
use calibrant_core::sensor::{Axis, SensorKind};

/// The columns of one of the two files; `sensor_kind` is its sensor, where that is known.
pub(super) fn draft(head: &Head<'_>, sensor_kind: Option<SensorKind>) -> Checked<Draft> {
    let columns = in_order(head, sensor_kind.unwrap_or(SensorKind::Accelerometer), 3)?;
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

/// The columns of a text without a header in their order: `t x y z`, or fewer axes.
pub(super) fn in_order(head: &Head<'_>, sensor_kind: SensorKind, axes: usize) -> Checked<Vec<ImuColumn>> {
    let (columns, needed) = (head.fields(), axes + 1);
    if columns < needed {
        let message =
            format!("{columns} column{} where {needed} are needed", if columns == 1 { "" } else { "s" });
        let order = if axes == 1 { "t x" } else { "t x y z" };
        let help = format!("without a header the columns are {order}");
        return Err(InputError::new(Refusal::ColumnMissing, message, help).at_line(head.line()).into());
    }
    let of_order = |column: usize| match column {
        0 => ImuColumn::new("1", ColumnMeaning::Time, Some(ColumnUnit::Time(TimeUnit::Second))),
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
    let column = |name: &&str| {
        let axis = ["x", "y", "z"].iter().position(|axis| name.eq_ignore_ascii_case(axis));
        axis.map_or_else(
            || column_names::column(name),
            |k| ImuColumn::new(name, ColumnMeaning::Reading(sensor_kind, Axis::ALL[k]), None),
        )
    };
    head.names.iter().map(column).collect()
}
