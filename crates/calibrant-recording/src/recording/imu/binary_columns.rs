//! Columns of numbers that are not text: of an MCAP bag, of Parquet, or in memory.

use super::column_values::{READINGS, SLOTS, Samples, TIME, slots_of};
use crate::recording::row_parser::Sense;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::{InputError, Refusal};
use calibrant_core::sensor::SensorKind;
use nalgebra::Vector3;

impl Samples {
    /// Values that were read elsewhere, a list for each slot: all of the same length, or empty.
    pub(super) fn from_columns(columns: [Vec<f64>; SLOTS], origin: i64) -> Checked<Self> {
        let rows = columns.iter().map(Vec::len).max().unwrap_or(0);
        if columns.iter().any(|column| !column.is_empty() && column.len() != rows) {
            return refuse(
                Refusal::FileDamaged,
                "the columns have different lengths",
                "was the file written to its end?",
            );
        }
        let (mut invalid, mut first) = (0, None);
        for (slot, column) in columns.iter().enumerate() {
            // NaN is a missing value
            for (row, &value) in column.iter().enumerate().filter(|(_, value)| !value.is_nan()) {
                match Sense::of(value, READINGS.contains(&slot)) {
                    Sense::Some => continue,
                    Sense::None if slot == TIME && value.is_finite() => continue,
                    Sense::None => return Err(out_of_range(value, row)),
                    Sense::Invalid => invalid += 1,
                }
                first = first.or(Some((value, row)));
            }
        }
        if let Some((value, row)) = first.filter(|_| Sense::is_lost(invalid, rows)) {
            return Err(out_of_range(value, row));
        }
        let sensor_kinds = SensorKind::ALL.map(|sensor_kind| {
            let axes = slots_of(sensor_kind).map(|slot| columns[slot].as_slice());
            let rows = axes.iter().map(|axis| axis.len()).max().unwrap_or(0);
            // a sensor with fewer axes reads nothing along the others
            let reading = |row: usize| axes.map(|axis| axis.get(row).copied().unwrap_or(0.0));
            (0..rows).map(|row| Vector3::from(reading(row))).collect()
        });
        let [times, .., temperatures, counts, _] = columns;
        Ok(Self { times, counts, temperatures, sensor_kinds, rows, origin, ..Self::default() })
    }
}

fn out_of_range(value: f64, row: usize) -> Box<InputError> {
    let message = format!("the value {value:e} in row {} is out of range", row + 1);
    InputError::new(Refusal::ValueOutOfRange, message, "is the unit right? is the file damaged?").into()
}
