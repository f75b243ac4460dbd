//! The rows of a recording: one pass over the text, every row checked against the one before.

use super::columns::Columns;
use super::finding::{Finding, FindingKind, Tally, count};
use crate::error::Complaint;
use crate::io::delimited::{Delimiter, Line};
use crate::io::text::Checked;
use nalgebra::Vector3;

/// Largest time and reading that make sense, in any unit.
const LARGEST: f64 = 1e12;

/// The samples so far, and what was noticed on the way.
pub(super) struct Rows<'c> {
    columns: &'c Columns,
    pub(super) times_s: Vec<f64>,
    pub(super) readings: Vec<Vector3<f64>>,
    pub(super) lines: LineMap,
    rows: usize,
    width: Width,
    missing: Tally,
    duplicate_rows: Tally,
    duplicate_times: Tally,
    truncated: Option<usize>,
}

/// What is wrong with a row.
struct RowError {
    complaint: Box<Complaint>,
    /// Would it be right had the line not been cut off?
    cut: bool,
}

/// Length of the rows, where all have the same: what is shorter was cut off.
#[derive(Clone, Copy)]
enum Width {
    Unknown,
    Fixed(usize),
    Varies,
}

impl<'c> Rows<'c> {
    /// No rows yet; `capacity` is a guess of how many there will be.
    pub(super) fn new(columns: &'c Columns, capacity: usize) -> Self {
        Self {
            columns,
            times_s: Vec::with_capacity(capacity),
            readings: Vec::with_capacity(capacity),
            lines: LineMap::default(),
            rows: 0,
            width: Width::Unknown,
            missing: Tally::default(),
            duplicate_rows: Tally::default(),
            duplicate_times: Tally::default(),
            truncated: None,
        }
    }

    /// Number of rows, dropped ones included.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Takes one line.
    pub(super) fn take(&mut self, line: Line<'_>) -> Checked<()> {
        if line.is_void() {
            return Ok(());
        }
        self.rows += 1;
        let values = match self.values(line) {
            // the last line may end anywhere when a logger was switched off
            _ if !line.terminated && self.rows > 1 && self.is_cut(line) => {
                self.truncated = Some(line.number);
                return Ok(());
            }
            Err(error) if !line.terminated && self.rows > 1 && error.cut => {
                self.truncated = Some(line.number);
                return Ok(());
            }
            values => values.map_err(|error| error.complaint)?,
        };
        self.width = match self.width {
            Width::Unknown => Width::Fixed(line.text.len()),
            Width::Fixed(width) if width != line.text.len() => Width::Varies,
            width => width,
        };
        let Some([t, x, y, z]) = values else {
            self.missing.add(line.number);
            return Ok(());
        };
        self.push(t, Vector3::new(x, y, z) * self.columns.factor, line)
    }

    /// Is this line shorter than all rows before, which have the same length (numbers in columns)?
    fn is_cut(&self, line: Line<'_>) -> bool {
        self.columns.delimiter == Delimiter::Whitespace
            && matches!(self.width, Width::Fixed(width) if self.rows > 3 && line.text.len() < width)
    }

    /// Time and readings of a row; `None` where one is missing.
    fn values(&self, line: Line<'_>) -> Result<Option<[f64; 4]>, RowError> {
        let slots = &self.columns.slots;
        let mut values = [0.0; 4];
        let mut missing = false;
        let mut fields = 0;
        let mut last_is_empty = false;
        for (offset, field) in line.fields(self.columns.delimiter) {
            if let Some(Some(slot)) = slots.get(fields).copied() {
                match number(field) {
                    Some(value) if value.is_nan() => missing = true,
                    Some(value) if value.abs() <= LARGEST => values[slot] = value,
                    Some(_) => return Err(self.out_of_range(field, fields, line, offset)),
                    None => return Err(self.not_a_number(field, fields, line, offset)),
                }
            }
            fields += 1;
            last_is_empty = field.is_empty();
        }
        // a delimiter at the end of the line is no column
        if fields == slots.len() || (fields == slots.len() + 1 && last_is_empty) {
            return Ok((!missing).then_some(values));
        }
        let help = if fields < slots.len() {
            "was the line cut off, or written while the file was read?"
        } else {
            "numbers need a decimal point, not a comma; columns need one delimiter"
        };
        let before = if self.columns.has_header { "the header" } else { "the first row" };
        let message = format!("{fields} columns where {before} has {}", slots.len());
        Err(RowError {
            complaint: Complaint::new(message, help).at_line(line.number).into(),
            cut: fields < slots.len(),
        })
    }

    fn out_of_range(&self, field: &str, column: usize, line: Line<'_>, offset: usize) -> RowError {
        let is_time = self.columns.slots.get(column) == Some(&Some(0));
        let help = if is_time { "times are in seconds" } else { "is the unit right? is the file damaged?" };
        let message = format!("{} in {} is out of range", quote(field), self.columns.name(column));
        let complaint = Complaint::new(message, help).at_line(line.number).at_column(line.column(offset));
        RowError { complaint: complaint.into(), cut: false }
    }

    fn not_a_number(&self, field: &str, column: usize, line: Line<'_>, offset: usize) -> RowError {
        let help = if field.contains(',') {
            "numbers need a decimal point, not a comma"
        } else if column == 0 && self.rows > 1 && field.eq_ignore_ascii_case("t_s") {
            "a second header: are these files put together? keep one of them"
        } else {
            "numbers look like 9.81 or 1e-3; a missing value is an empty field or NaN"
        };
        let message = format!("{} in {} is not a number", quote(field), self.columns.name(column));
        let complaint = Complaint::new(message, help).at_line(line.number).at_column(line.column(offset));
        RowError {
            complaint: complaint.into(),
            cut: offset + field.len() >= line.text.trim_ascii_end().len(),
        }
    }

    fn push(&mut self, t: f64, reading: Vector3<f64>, line: Line<'_>) -> Checked<()> {
        if let (Some(&before), Some(last)) = (self.times_s.last(), self.readings.last()) {
            if t == before {
                let same = *last == reading;
                if same { &mut self.duplicate_rows } else { &mut self.duplicate_times }.add(line.number);
                return Ok(());
            }
            if t < before {
                return Err(Complaint::new(
                    format!("time goes backwards, from {before:?} s to {t:?} s"),
                    "are these files put together, or did a counter wrap? split the file here",
                )
                .at_line(line.number)
                .into());
            }
        }
        self.lines.push(self.times_s.len(), line.number);
        self.times_s.push(t);
        self.readings.push(reading);
        Ok(())
    }

    /// Puts into words what was noticed.
    pub(super) fn report(&self, findings: &mut Vec<Finding>) {
        self.missing.report(FindingKind::Missing, findings, |n| {
            format!("{} with a missing or NaN value dropped", count(n, "sample"))
        });
        self.duplicate_rows.report(FindingKind::DuplicateRow, findings, |n| {
            format!("{} equal to the one before dropped", count(n, "row"))
        });
        self.duplicate_times.report(FindingKind::DuplicateTime, findings, |n| {
            format!("{} with the time of the one before but another reading dropped", count(n, "row"))
        });
        if let Some(line) = self.truncated {
            let message = "truncated last line dropped".to_owned();
            findings.push(Finding::new(FindingKind::TruncatedLastLine, Some(line), message));
        }
    }
}

/// A field as a number; NaN where it is missing, `None` where it is something else.
fn number(field: &str) -> Option<f64> {
    if let Ok(value) = field.parse() {
        return Some(value);
    }
    let missing = field.is_empty()
        || ["na", "n/a", "null", "none", "nan(ind)", "-nan(ind)", "1.#qnan", "-1.#ind"]
            .iter()
            .any(|word| field.eq_ignore_ascii_case(word));
    missing.then_some(f64::NAN)
}

fn quote(field: &str) -> String {
    let shown: String = field.chars().take(40).collect();
    format!("\"{}\"{}", shown.escape_debug(), if shown.len() < field.len() { "…" } else { "" })
}

/// The line of each sample, stored only where it is not the line after the sample before.
#[derive(Default)]
pub(super) struct LineMap {
    breaks: Vec<(usize, usize)>,
}

impl LineMap {
    fn push(&mut self, sample: usize, line: usize) {
        if self.breaks.last().is_none_or(|(first, start)| start + (sample - first) != line) {
            self.breaks.push((sample, line));
        }
    }

    /// Line of a sample.
    pub(super) fn line(&self, sample: usize) -> Option<usize> {
        let after = self.breaks.partition_point(|(first, _)| *first <= sample);
        let (first, line) = self.breaks.get(after.checked_sub(1)?)?;
        Some(line + (sample - first))
    }
}
