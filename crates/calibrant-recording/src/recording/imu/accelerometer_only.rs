//! The accelerometer alone: from a plain text of its readings, or from a recording in any format.

use super::column::{ColumnMeaning, ImuColumn};
use super::file::ImuFile;
use super::file_layout::Draft;
use super::format::FileFormat;
use super::options::{AccelerometerOnly, ImuReadOptions};
use super::{column_names, imu_tk};
use crate::recording::text_header::Head;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::{ColumnsIgnored, UnitUnexpected};
use calibrant_core::error::Refusal;
use calibrant_core::sensor::{Axis, ImuRecording, SensorKind};

/// The layout of a plain text of one accelerometer: a time and `ax,ay,az`, or `t x y z` without a header. `None`
/// for any other file, and where `[columns]` names the columns.
pub(super) fn plain(head: &Head<'_>, format: FileFormat, options: &ImuReadOptions) -> Checked<Option<Draft>> {
    let Some(only) = options.accelerometer_only.filter(|_| options.columns.is_empty()) else {
        return Ok(None);
    };
    let mut columns = match (format, head.names.is_empty()) {
        (FileFormat::Csv | FileFormat::ImuTk, true) => {
            imu_tk::in_order(head, SensorKind::Accelerometer, only.axes, options)?
        }
        (FileFormat::Csv, false) => named(&head.names, only),
        _ => return Ok(None),
    };
    for column in &mut columns {
        // names in a comment are no header: without a unit the times are those of `t x y z`
        if is_time(column) && head.first_row.is_some() {
            column.unit = column.unit.or(imu_tk::in_seconds(head, options));
        }
    }
    Ok(laid_out(format, columns, only))
}

/// The layout of a table in memory, as [`plain`].
pub(super) fn plain_columns(names: &[&str], options: &ImuReadOptions) -> Option<Draft> {
    let only = options.accelerometer_only.filter(|_| options.columns.is_empty())?;
    laid_out(FileFormat::Columns, named(names, only), only)
}

fn laid_out(format: FileFormat, mut columns: Vec<ImuColumn>, only: AccelerometerOnly) -> Option<Draft> {
    if !columns.iter().any(is_time) || columns.iter().all(|column| axis(column).is_none()) {
        return None;
    }
    for column in &mut columns {
        if axis(column).is_some_and(|axis| axis.index() >= only.axes) {
            column.unused = Some("the sensor has fewer axes".into());
        }
    }
    Some(Draft { plain: Some(only), ..Draft::new(format, columns) })
}

/// The columns that have names. Only those of the time and of the axes are looked at, and of the temperature where it is wanted; of times only
/// `t_s` where it is there.
fn named(names: &[&str], only: AccelerometerOnly) -> Vec<ImuColumn> {
    let is_plain_time = |name: &&str| name.eq_ignore_ascii_case("t_s");
    let has_plain_time = names.iter().any(is_plain_time);
    let column = |name: &&str| {
        let column = column_names::column(name);
        let is_needed = match column.meaning {
            ColumnMeaning::Time => is_plain_time(name) || !has_plain_time,
            ColumnMeaning::Temperature => only.with_temperature,
            _ => column_names::is_plain_axis(name),
        };
        if is_needed { column } else { ImuColumn::new(name, ColumnMeaning::Other, None) }
    };
    names.iter().map(column).collect()
}

fn is_time(column: &ImuColumn) -> bool {
    column.meaning == ColumnMeaning::Time
}

fn axis(column: &ImuColumn) -> Option<Axis> {
    match column.meaning {
        ColumnMeaning::Reading(_, axis) => Some(axis),
        _ => None,
    }
}

/// Keeps the accelerometer alone, and of it the axes that are needed.
pub(super) fn only(mut file: ImuFile, draft: &Draft, options: &ImuReadOptions) -> Checked<ImuFile> {
    let Some(AccelerometerOnly { axes, unit: expected, with_temperature }) = options.accelerometer_only
    else {
        return Ok(file);
    };
    let Some(recording) = file.recording[SensorKind::Accelerometer].take() else {
        return refuse(
            Refusal::SensorMissing,
            format!("the recording has no {}", SensorKind::Accelerometer),
            "`calibrant inspect` says what it has",
        );
    };
    let recording = recording.with_axes(axes);
    let mut found = Vec::new();
    let unused = file.columns.iter().filter(|column| !column.is_used());
    let names: Vec<String> = unused.map(|column| column.name.clone()).collect();
    if draft.plain.is_some() && !names.is_empty() {
        found.push(ColumnsIgnored { columns: names, other: None }.into());
    }
    if options.accelerometer_unit.is_none() && recording.unit() != expected {
        found.push(UnitUnexpected { stated: recording.unit(), expected }.into());
    }
    file.findings.splice(0..0, found.into_iter().map(|found: Diagnostic| found.at_line(draft.line)));
    // a temperature that nobody wants says nothing of an accelerometer
    let is_wanted = with_temperature || options.columns.temperature.is_some();
    let temperature_c = file.recording.temperature_c.take().filter(|_| is_wanted);
    Ok(ImuFile { recording: ImuRecording { temperature_c, ..recording.into() }, ..file })
}
