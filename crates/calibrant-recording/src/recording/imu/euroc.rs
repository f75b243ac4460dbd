//! The columns of `imu0/data.csv` of the EuRoC MAV dataset:
//! `#timestamp [ns],w_RS_S_x [rad s^-1],…,a_RS_S_x [m s^-2],…`.

use super::column::{ColumnMeaning, ImuColumn};
use super::column_names;
use super::file_layout::Draft;
use super::format::FileFormat;
use super::unit::{ColumnUnit, ImuUnit};
use crate::recording::text_header::Head;
use crate::recording::time_unit::TimeUnit;
use calibrant_core::sensor::{Axis, SensorKind};

pub(super) fn draft(head: &Head<'_>) -> Draft {
    let columns = if head.names.is_empty() {
        // without its header (`--format euroc`): the columns of the format, in their order
        (0..head.fields())
            .map(|column| ImuColumn::new(&(column + 1).to_string(), of_order(column), unit(of_order(column))))
            .collect()
    } else {
        head.names
            .iter()
            .map(|name| column_names::column(name.trim_start_matches('#').trim_ascii_start()))
            .collect()
    };
    Draft::new(FileFormat::Euroc, columns)
}

fn of_order(column: usize) -> ColumnMeaning {
    match column {
        0 => ColumnMeaning::Time,
        1..=3 => ColumnMeaning::Reading(SensorKind::Gyroscope, Axis::ALL[column - 1]),
        4..=6 => ColumnMeaning::Reading(SensorKind::Accelerometer, Axis::ALL[column - 4]),
        _ => ColumnMeaning::Other,
    }
}

fn unit(meaning: ColumnMeaning) -> Option<ColumnUnit> {
    match meaning {
        ColumnMeaning::Time => Some(ColumnUnit::Time(TimeUnit::Nanosecond)),
        ColumnMeaning::Reading(SensorKind::Gyroscope, _) => {
            Some(ColumnUnit::Reading(ImuUnit::RadianPerSecond))
        }
        ColumnMeaning::Reading(SensorKind::Accelerometer, _) => {
            Some(ColumnUnit::Reading(ImuUnit::MetrePerSecondSquared))
        }
        _ => None,
    }
}
