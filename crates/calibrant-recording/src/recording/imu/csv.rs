//! Delimited text whose header gives the meaning of the columns, or whose columns `[columns]` names.

use super::column::{ColumnMeaning, ImuColumn};
use super::file_layout::Draft;
use super::format::FileFormat;
use super::sample_clock::COMMENT;
use super::unit::{ColumnUnit, ImuUnit};
use super::{column_names, imu_tk};
use crate::recording::text_header::Head;
use calibrant_core::sensor::SensorKind;

/// The columns. `asked` is the sensor that the user names; its columns then need no name.
pub(super) fn draft(head: &Head<'_>, asked: Option<SensorKind>) -> Draft {
    let columns = if head.names.is_empty() {
        let other = |column: usize| ImuColumn::new(&(column + 1).to_string(), ColumnMeaning::Other, None);
        (0..head.fields()).map(other).collect()
    } else {
        let named: Vec<_> = head.names.iter().map(|name| column_names::column(name)).collect();
        match asked {
            Some(sensor_kind) if !named.iter().any(is_reading) => imu_tk::named(head, sensor_kind),
            Some(SensorKind::Gyroscope) if is_unnamed(&named) => {
                named.into_iter().map(of_gyroscope).collect()
            }
            _ => named,
        }
    };
    let rate_hz = head.rate_in_comments().map(|rate_hz| (rate_hz, COMMENT));
    Draft { rate_hz, ..Draft::new(FileFormat::Csv, columns) }
}

fn is_reading(column: &ImuColumn) -> bool {
    matches!(column.meaning, ColumnMeaning::Reading(..))
}

/// Are they the columns of one unnamed sensor, beside nothing but times? Loggers of one sensor call any of
/// them ax, ay, az.
fn is_unnamed(columns: &[ImuColumn]) -> bool {
    let may_be_another = |column: &ImuColumn| match column.unit {
        None | Some(ColumnUnit::Reading(ImuUnit::Counts)) => column_names::is_plain_axis(&column.name),
        _ => false,
    };
    columns.iter().all(|column| match column.meaning {
        ColumnMeaning::Reading(..) => may_be_another(column),
        ColumnMeaning::Time | ColumnMeaning::Counter => true,
        _ => false,
    })
}

fn of_gyroscope(column: ImuColumn) -> ImuColumn {
    match column.meaning {
        ColumnMeaning::Reading(_, axis) => {
            ImuColumn { meaning: ColumnMeaning::Reading(SensorKind::Gyroscope, axis), ..column }
        }
        _ => column,
    }
}
