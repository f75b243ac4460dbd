//! The values of the rows of a log.

use super::text_columns::TextColumns;
use crate::recording::TimeUnit;
use crate::recording::line_map::LineMap;
use crate::recording::row_parser::{Layout, RowReader};
use crate::recording::text_source::RowTaker;
use crate::text::decoding::Checked;
use crate::text::delimited::Line;

/// The values of a log as the file gives them, row by row. NaN is a missing value.
#[derive(Default)]
pub(super) struct Rows {
    /// The times, in the ticks of the file's clock.
    pub(super) times: Vec<f64>,
    /// As many values for each row as the content has.
    pub(super) values: Vec<f64>,
    /// Lines of the rows; empty for a file that has none.
    pub(super) lines: LineMap,
    /// The number that was subtracted from each time, in its ticks.
    pub(super) origin: i64,
    /// Line that was cut off, where the last one was.
    pub(super) truncated: Option<usize>,
    /// Last line of the text.
    pub(super) last_line: Option<usize>,
}

/// Reads the rows of a text.
pub(super) struct LogReader<'l> {
    reader: RowReader<'l>,
    rows: Rows,
    factors: &'l [f64],
    /// The first whole second, where another column has the rest of it, and the ticks in a second of that.
    seconds: Option<(Option<f64>, f64)>,
    /// Rate of the frames, Hz, where they stand in the place of times.
    rate_hz: Option<f64>,
    /// The time and the values of a row, then the rest of its second.
    row: Vec<f64>,
}

impl<'l> LogReader<'l> {
    /// No rows yet; `capacity` is a guess of how many there will be.
    pub(super) fn new(layout: &'l Layout, columns: &'l TextColumns, capacity: usize) -> Self {
        let factors = &columns.values.factors;
        let rows = Rows {
            times: Vec::with_capacity(capacity),
            values: Vec::with_capacity(capacity.saturating_mul(factors.len())),
            ..Rows::default()
        };
        let seconds = columns.rest.and_then(TimeUnit::per_second).map(|per_second| (None, per_second));
        let row = vec![f64::NAN; 2 + factors.len()];
        Self { reader: RowReader::new(layout), rows, factors, seconds, rate_hz: columns.rate_hz, row }
    }

    pub(super) fn finish(mut self) -> Rows {
        self.rows.origin = match self.seconds {
            Some((first, per_second)) => (first.unwrap_or(0.0) * per_second) as i64,
            None => self.reader.origin.unwrap_or(0),
        };
        self.rows.truncated = self.reader.truncated;
        self.rows
    }
}

impl RowTaker for LogReader<'_> {
    fn take<'t>(&mut self, lines: impl Iterator<Item = Line<'t>>, text: &str) -> Checked<()> {
        self.reader.look_at_the_end(text);
        for line in lines {
            self.rows.last_line = Some(line.number);
            if !self.reader.read(line, &mut self.row)? {
                continue;
            }
            self.rows.lines.push(self.rows.times.len(), line.number);
            let time = match &mut self.seconds {
                Some((first, per_second)) => {
                    let first = *first.get_or_insert(self.row[0]);
                    (self.row[0] - first) * *per_second + self.row[1 + self.factors.len()]
                }
                None => self.row[0] / self.rate_hz.unwrap_or(1.0),
            };
            self.rows.times.push(time);
            let values = self.row[1..].iter().zip(self.factors);
            self.rows.values.extend(values.map(|(value, factor)| value * factor));
        }
        Ok(())
    }

    fn last_line(&self) -> Option<usize> {
        self.rows.last_line
    }
}
