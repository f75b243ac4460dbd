//! Rows of one sensor each: a column says which, and the axes of both share three columns.

use super::column::{ColumnMeaning, ImuColumn};
use super::column_names::sensor_named;
use super::file_layout::Draft;
use super::first_rows::FirstRows;
use super::options::{ColumnMapping, ImuReadOptions};
use calibrant_core::sensor::{Axis, SensorKind};

/// The column that names the sensor of each row. The axes are then read as the accelerometer's, and moved. `None` where the rows are no such ones.
pub(super) fn find(draft: &mut Draft, rows: &FirstRows<'_>, options: &ImuReadOptions) -> Option<usize> {
    let axes = axes(draft, &options.columns)?;
    let names_both = |column: &usize| {
        let found: Vec<Option<SensorKind>> = rows.column(*column).map(sensor_named).collect();
        SensorKind::ALL.iter().all(|sensor_kind| found.contains(&Some(*sensor_kind)))
            && rows.column(*column).all(|field| field.parse::<f64>().is_err())
    };
    let column = (0..draft.columns.len()).find(names_both)?;
    draft.columns[column].unused = Some("it names the sensor of each row".into());
    for (place, axis) in axes.into_iter().zip(Axis::ALL) {
        let meaning = ColumnMeaning::Reading(SensorKind::Accelerometer, axis);
        draft.columns[place] = ImuColumn::new(&draft.columns[place].name, meaning, None);
    }
    Some(column)
}

/// The columns x, y, z: by their names, or where `[columns]` gives the same to both sensors.
fn axes(draft: &Draft, mapping: &ColumnMapping) -> Option<[usize; 3]> {
    let place = |name: &str| draft.columns.iter().position(|column| column.name.eq_ignore_ascii_case(name));
    let names = match (&mapping.accelerometer, &mapping.gyroscope) {
        (Some(one), Some(other)) if one == other => one.each_ref().map(String::as_str),
        (None, None) => ["x", "y", "z"],
        _ => return None,
    };
    let [x, y, z] = names.map(place);
    Some([x?, y?, z?])
}
