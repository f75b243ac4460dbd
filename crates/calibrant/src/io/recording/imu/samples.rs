//! The values of a file's used columns, as they are in the file, whatever its format.

use super::column::ColumnMeaning;
use crate::error::Complaint;
use crate::io::delimited::Line;
use crate::io::recording::row::{LARGEST, Layout, RowReader};
use crate::io::recording::rows::LineMap;
use crate::io::text::Checked;
use crate::sensor::{Axis, Triad};

/// Number of slots: time, three axes of each sensor, temperature, counter.
pub(super) const SLOTS: usize = 9;
pub(super) const TIME: usize = 0;
pub(super) const TEMPERATURE: usize = 7;
pub(super) const COUNTER: usize = 8;

/// Where the values of a column of this meaning go.
pub(super) fn slot_of(meaning: ColumnMeaning) -> Option<usize> {
    match meaning {
        ColumnMeaning::Time => Some(TIME),
        ColumnMeaning::Reading(triad, axis) => Some(slots_of(triad)[axis.index()]),
        ColumnMeaning::Temperature => Some(TEMPERATURE),
        ColumnMeaning::Counter => Some(COUNTER),
        _ => None,
    }
}

/// The slots of a sensor's axes.
pub(super) fn slots_of(triad: Triad) -> [usize; 3] {
    let first = match triad {
        Triad::Accelerometer => 1,
        Triad::Gyroscope => 4,
    };
    Axis::ALL.map(|axis| first + axis.index())
}

/// The values of a file, one list for each slot that has a column; NaN where one is missing.
#[derive(Default)]
pub(super) struct Samples {
    columns: [Vec<f64>; SLOTS],
    /// Number of rows.
    pub(super) rows: usize,
    /// Lines of the rows; empty for a file that has none.
    pub(super) lines: LineMap,
    /// What was taken from each time, in its ticks, so that they are exact.
    pub(super) origin: i64,
    /// Line that was cut off, where the last one was.
    pub(super) truncated: Option<usize>,
    /// Last line of the text.
    pub(super) last_line: Option<usize>,
}

impl Samples {
    /// The values of a slot; empty where it has no column.
    pub(super) fn slot(&self, slot: usize) -> &[f64] {
        &self.columns[slot]
    }

    /// Values that were read elsewhere, a list for each slot: all of the same length, or empty.
    pub(super) fn from_columns(columns: [Vec<f64>; SLOTS], origin: i64) -> Checked<Self> {
        let rows = columns.iter().map(Vec::len).max().unwrap_or(0);
        if columns.iter().any(|column| !column.is_empty() && column.len() != rows) {
            return Err(Complaint::new(
                "the columns have different lengths",
                "was the file written to its end?",
            )
            .into());
        }
        for (slot, column) in columns.iter().enumerate() {
            let most = if slot == TIME { f64::MAX } else { LARGEST };
            // NaN is a missing value
            if let Some(row) = column.iter().position(|value| value.abs() > most) {
                let message = format!("the value {:e} in row {} is out of range", column[row], row + 1);
                return Err(Complaint::new(message, "is the unit right? is the file damaged?").into());
            }
        }
        Ok(Self { columns, rows, origin, ..Self::default() })
    }

    /// Reads the rows of a text.
    pub(super) fn of_text<'t>(
        layout: &Layout,
        lines: impl Iterator<Item = Line<'t>>,
        capacity: usize,
    ) -> Checked<Self> {
        let mut samples = Self::default();
        let used: Vec<usize> = layout.slots.iter().flatten().copied().collect();
        for &slot in &used {
            samples.columns[slot].reserve(capacity);
        }
        let mut reader = RowReader::new(layout);
        for line in lines {
            samples.last_line = Some(line.number);
            let Some(values) = reader.read::<SLOTS>(line)? else { continue };
            samples.lines.push(samples.rows, line.number);
            samples.rows += 1;
            for &slot in &used {
                samples.columns[slot].push(values[slot]);
            }
        }
        samples.origin = reader.origin.unwrap_or(0);
        samples.truncated = reader.truncated;
        Ok(samples)
    }
}
