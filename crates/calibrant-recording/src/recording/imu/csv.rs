//! Delimited text whose header gives the meaning of the columns, or whose columns `[columns]` names.

use super::column::{ColumnMeaning, ImuColumn};
use super::file_layout::Draft;
use super::format::FileFormat;
use super::imu_tk;
use super::names_of_file::{are_unnamed, columns, is_reading};
use super::sample_clock::COMMENT;
use crate::recording::text_header::Head;
use calibrant_core::sensor::SensorKind;

/// The columns. `asked` is the sensor that the user names; its columns then need no name.
pub(super) fn draft(head: &Head<'_>, asked: Option<SensorKind>) -> Draft {
    let found = if head.names.is_empty() {
        let other = |column: usize| ImuColumn::new(&(column + 1).to_string(), ColumnMeaning::Other, None);
        (0..head.fields()).map(other).collect()
    } else {
        let named = columns(head);
        match asked {
            Some(sensor_kind) if !named.iter().any(is_reading) => imu_tk::named(head, sensor_kind),
            Some(SensorKind::Gyroscope) if are_unnamed(&named) => {
                named.into_iter().map(of_gyroscope).collect()
            }
            _ => named,
        }
    };
    let rate_hz = head.rate_in_comments().map(|rate_hz| (rate_hz, COMMENT));
    Draft { rate_hz, ..Draft::new(FileFormat::Csv, found) }
}

fn of_gyroscope(column: ImuColumn) -> ImuColumn {
    match column.meaning {
        ColumnMeaning::Reading(_, axis) => {
            ImuColumn { meaning: ColumnMeaning::Reading(SensorKind::Gyroscope, axis), ..column }
        }
        _ => column,
    }
}
