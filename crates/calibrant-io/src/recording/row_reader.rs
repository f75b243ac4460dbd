//! Reads the rows of a recording: one pass over the text, every row checked against the one before.

use super::columns::Columns;
use super::reader_finding::{Finding, Noticed, Tally};
use super::row_parser::RowReader;
use crate::delimited_text::Line;
use crate::text_decoding::Checked;
use calibrant_core::error::{InputError, Refusal};
use nalgebra::Vector3;

/// The samples so far, and the findings.
pub(super) struct Rows<'c> {
    columns: &'c Columns,
    reader: RowReader<'c>,
    pub(super) times_s: Vec<f64>,
    pub(super) readings: Vec<Vector3<f64>>,
    pub(super) lines: LineMap,
    missing: Tally,
    duplicate_rows: Tally,
    duplicate_times: Tally,
}

impl<'c> Rows<'c> {
    /// No rows yet; `capacity` is a guess of how many there will be.
    pub(super) fn new(columns: &'c Columns, capacity: usize) -> Self {
        Self {
            columns,
            reader: RowReader::new(&columns.layout),
            times_s: Vec::with_capacity(capacity),
            readings: Vec::with_capacity(capacity),
            lines: LineMap::default(),
            missing: Tally::default(),
            duplicate_rows: Tally::default(),
            duplicate_times: Tally::default(),
        }
    }

    /// Examines the end of the text that holds the lines.
    pub(super) fn look_at_the_end(&mut self, text: &str) {
        self.reader.look_at_the_end(text);
    }

    /// Number of rows, dropped ones included.
    pub(super) fn rows(&self) -> usize {
        self.reader.rows()
    }

    /// Takes one line.
    pub(super) fn take(&mut self, line: Line<'_>) -> Checked<()> {
        let mut values = [f64::NAN; 4];
        if !self.reader.read(line, &mut values)? {
            return Ok(());
        }
        let axes = self.columns.axes;
        if values[..=axes].iter().any(|value| value.is_nan()) {
            self.missing.add(Some(line.number));
            return Ok(());
        }
        let reading = Vector3::from_fn(|axis, _| if axis < axes { values[axis + 1] } else { 0.0 });
        self.push(values[0], reading * self.columns.factor, line)
    }

    /// Returns an error for implausible readings, where they are too many to be a few bad samples.
    pub(super) fn check_invalid(&mut self) -> Checked<()> {
        self.reader.check_invalid()
    }

    fn push(&mut self, t: f64, reading: Vector3<f64>, line: Line<'_>) -> Checked<()> {
        if let (Some(&before), Some(last)) = (self.times_s.last(), self.readings.last()) {
            if t == before {
                let same = *last == reading;
                if same { &mut self.duplicate_rows } else { &mut self.duplicate_times }
                    .add(Some(line.number));
                return Ok(());
            }
            if t < before {
                return Err(backwards(before, t).at_line(line.number).into());
            }
        }
        self.lines.push(self.times_s.len(), line.number);
        self.times_s.push(t);
        self.readings.push(reading);
        Ok(())
    }

    /// The findings about the rows.
    pub(super) fn report(&self, findings: &mut Vec<Finding>) {
        self.missing.report(findings, None, Noticed::ValuesMissing);
        report_duplicates(&self.duplicate_rows, &self.duplicate_times, findings);
        report_truncated(self.reader.truncated, findings);
    }
}

/// The error for a time that goes backwards, s.
pub(super) fn backwards(before: f64, t: f64) -> InputError {
    InputError::new(
        Refusal::TimesNotIncreasing,
        format!("time goes backwards, from {before:?} s to {t:?} s"),
        "are these files put together, or did a counter wrap? split the file here",
    )
}

/// The findings about rows that repeat the one before, or only its time.
pub(super) fn report_duplicates(rows: &Tally, times: &Tally, findings: &mut Vec<Finding>) {
    rows.report(findings, None, Noticed::RowsRepeated);
    times.report(findings, None, Noticed::TimesRepeated);
}

/// The finding about a last line that was cut off.
pub(super) fn report_truncated(line: Option<usize>, findings: &mut Vec<Finding>) {
    if line.is_some() {
        findings.push(Finding::new(Noticed::LineTruncated).at(line));
    }
}

/// The line of each sample, stored only where it is not the line after the sample before.
#[derive(Default)]
pub(super) struct LineMap {
    breaks: Vec<(usize, usize)>,
}

impl LineMap {
    pub(super) fn push(&mut self, sample: usize, line: usize) {
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
