//! The first rows of a text: the content of its columns before its rows are read.

use super::column::{ColumnMeaning, ImuColumn};
use super::file_layout::Draft;
use super::unit::ColumnUnit;
use crate::recording::split_clock::SplitClock;
use crate::recording::text_header::Head;
use crate::recording::text_times::{DAY_NS, TextTime};
use crate::recording::time_unit::TimeUnit;
use crate::text::delimited::Delimiter;

/// Number of rows that are looked at.
const MOST: usize = 400;
/// Fewer rows show nothing of a column.
const FEWEST: usize = 20;

/// The first rows, field by field.
pub(super) struct FirstRows<'t> {
    rows: Vec<Vec<&'t str>>,
}

impl<'t> FirstRows<'t> {
    pub(super) fn of(head: &Head<'t>) -> Self {
        let lines = head.first_row.into_iter().chain(head.rest.clone()).filter(|line| !line.is_void());
        let fields = |line: crate::text::delimited::Line<'t>| {
            line.fields(head.delimiter).map(|(_, field)| field.trim()).collect()
        };
        // the last line may be cut off
        let mut rows: Vec<Vec<&str>> = lines.take(MOST).map(fields).collect();
        if rows.len() > FEWEST {
            rows.pop();
        }
        Self { rows }
    }

    /// The fields of a column; of short rows none.
    pub(super) fn column(&self, column: usize) -> impl Iterator<Item = &'t str> {
        self.rows.iter().filter_map(move |row| row.get(column).copied())
    }

    /// Are these enough rows to know a column by them?
    pub(super) fn are_enough(&self) -> bool {
        self.rows.len() >= FEWEST
    }

    /// The times of a column in its own ticks, those of a text in ns; NaN where there is none.
    pub(super) fn times(&self, column: usize) -> Vec<f64> {
        let time = |field: &str| {
            let of_text = || TextTime::parse(field).map(|time| time.ns as f64);
            field.parse().ok().or_else(of_text).unwrap_or(f64::NAN)
        };
        self.column(column).map(time).collect()
    }

    /// Have numbers a decimal comma? `1,234` alone may be a thousand.
    pub(super) fn have_decimal_commas(&self, delimiter: Delimiter) -> bool {
        let is_one = |field: &&str| {
            let parts = field.split_once(',');
            let digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
            parts.is_some_and(|(whole, rest)| {
                digits(whole.trim_start_matches('-')) && digits(rest) && rest.len() != 3
            })
        };
        delimiter != Delimiter::Character(b',') && self.rows.iter().flatten().any(is_one)
    }

    /// Finds a clock of two columns: whole seconds, and the rest of them, as in `sec` and `nanosec`.
    pub(super) fn find_split_clock(&self, draft: &mut Draft) {
        let names: Vec<String> = draft.columns.iter().map(|column| column.name.clone()).collect();
        let Some(SplitClock { seconds, rest, unit }) = SplitClock::find(&names, |k| self.times(k)) else {
            return;
        };
        for column in draft.columns.iter_mut().filter(|column| column.meaning == ColumnMeaning::Time) {
            *column = ImuColumn::new(&column.name, ColumnMeaning::Clock, column.unit);
        }
        let unit = Some(ColumnUnit::Time(unit));
        for (k, meaning) in [(seconds, ColumnMeaning::Time), (rest, ColumnMeaning::RestOfSecond)] {
            draft.columns[k] = ImuColumn::new(&draft.columns[k].name, meaning, unit);
        }
    }

    /// The unit of ticks within a second: the coarsest in which all are less than one.
    pub(super) fn unit_of_rest(&self, column: usize) -> TimeUnit {
        let most = self.times(column).into_iter().fold(0.0, f64::max);
        let units = [TimeUnit::Millisecond, TimeUnit::Microsecond, TimeUnit::Nanosecond];
        let fits = |unit: &TimeUnit| unit.per_second().is_some_and(|per_second| most < per_second);
        units.into_iter().find(fits).unwrap_or(TimeUnit::Nanosecond)
    }

    /// May a column of numbers be a clock or a counter? It only goes up, in most rows.
    fn goes_up(&self, column: usize) -> bool {
        let times = self.times(column);
        let steps = || times.array_windows().map(|[one, next]| next - one);
        self.are_enough()
            && steps().all(|step| step >= 0.0)
            && 2 * steps().filter(|step| *step > 0.0).count() > times.len()
    }

    /// Finds clocks by the content of the columns: times that are given as text, and numbers that only go up.
    pub(super) fn find_clocks(&self, draft: &mut Draft) {
        for k in 0..draft.columns.len() {
            let column = &mut draft.columns[k];
            let may_be = [ColumnMeaning::Time, ColumnMeaning::Clock, ColumnMeaning::Other];
            let Some(first) = self.column(k).find(|field| !field.is_empty()) else { continue };
            if !may_be.contains(&column.meaning) {
                continue;
            }
            if first.parse::<f64>().is_ok() {
                if column.meaning == ColumnMeaning::Other && self.goes_up(k) {
                    draft.may_be_clocks.push(column.name.clone());
                }
            } else if let Some(time) = TextTime::parse(first) {
                let meaning =
                    if column.meaning == ColumnMeaning::Time { column.meaning } else { ColumnMeaning::Clock };
                *column = ImuColumn::new(&column.name, meaning, Some(ColumnUnit::Time(TimeUnit::Nanosecond)));
                draft.texts.push((k, (!time.has_date).then_some(DAY_NS)));
            } else if column.meaning == ColumnMeaning::Clock {
                *column = ImuColumn::new(&column.name, ColumnMeaning::Calendar, None);
            }
        }
    }
}
