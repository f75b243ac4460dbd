//! Parses one row of a recording: its fields as numbers, each in its slot, or an error that points at the
//! field.

use crate::recording::text_times::TextTime;
use crate::text::decoding::Checked;
use crate::text::delimited::{Delimiter, Line, last_number_is_cut};
use calibrant_core::error::{InputError, Refusal};
use std::ops::Range;

/// Largest plausible time and reading, in any unit.
const LARGEST: f64 = 1e12;
/// A few readings up to this are invalid samples; the search for spikes finds them. Conversion to SI does not
/// overflow below it.
const LARGEST_INVALID: f64 = 1e300;
/// Implausible readings in more than one row of this number are not invalid samples.
const MOST_INVALID: usize = 50;

/// Is a value plausible in this slot? An implausible reading may still be an invalid sample.
pub(crate) enum Sense {
    Some,
    Invalid,
    None,
}

impl Sense {
    /// The plausibility of a value that is there.
    pub(crate) fn of(value: f64, may_be_invalid: bool) -> Self {
        match value.abs() {
            size if size <= LARGEST => Self::Some,
            size if size <= LARGEST_INVALID && may_be_invalid => Self::Invalid,
            _ => Self::None,
        }
    }

    /// Are there too many invalid samples for this number of rows?
    pub(crate) fn is_lost(invalid: usize, rows: usize) -> bool {
        invalid > rows / MOST_INVALID
    }
}
/// Whole numbers above this are not exact as `f64`.
const EXACT: u64 = 1 << 53;

/// The purpose of the columns of a text.
pub(crate) struct Layout {
    pub(crate) delimiter: Delimiter,
    /// For each column the slot of its values, `None` where it is not needed. Slot 0 is the time.
    pub(crate) slots: Vec<Option<usize>>,
    /// Names, for errors; empty where there is no header.
    pub(crate) names: Vec<String>,
    /// Is the line that they were found in a header (and not the first row)?
    pub(crate) has_header: bool,
    /// Are times whole ticks of a clock? They may then be larger than seconds can be.
    pub(crate) ticks: bool,
    /// Are times text, such as `13:35:38.42`?
    pub(crate) text_times: bool,
    /// The rows to read, where not all: a column, and its value in them.
    pub(crate) only: Option<(usize, String)>,
    /// Slots of readings, of which a few may be invalid samples.
    pub(crate) may_be_invalid: Range<usize>,
    /// Have numbers a decimal comma?
    pub(crate) decimal_comma: bool,
}

impl Layout {
    /// Name of a column, for errors.
    pub(crate) fn name(&self, column: usize) -> String {
        self.names
            .get(column)
            .map_or_else(|| format!("column {}", column + 1), |name| format!("column `{name}`"))
    }
}

/// Reads rows, and knows when the last one was cut off.
pub(crate) struct RowReader<'l> {
    layout: &'l Layout,
    rows: usize,
    width: Width,
    /// Line that was cut off, where the last one was.
    pub(crate) truncated: Option<usize>,
    /// Is the last line known to be cut off?
    last_is_cut: bool,
    /// The number that is subtracted from ticks that are too large to be exact as `f64`.
    pub(crate) origin: Option<i64>,
    /// Number of invalid readings, and the error about the first if they are too many.
    invalid: (usize, Option<Box<InputError>>),
}

/// The fault of a row.
struct RowError {
    input_error: Box<InputError>,
    /// Would it be right if the line had not been cut off?
    cut: bool,
}

/// Length of the rows, where all have the same: a shorter row was cut off.
#[derive(Clone, Copy)]
enum Width {
    Unknown,
    Fixed(usize),
    Varies,
}

impl<'l> RowReader<'l> {
    pub(crate) fn new(layout: &'l Layout) -> Self {
        Self {
            layout,
            rows: 0,
            width: Width::Unknown,
            truncated: None,
            last_is_cut: false,
            origin: None,
            invalid: (0, None),
        }
    }

    /// The separator of the fields.
    pub(crate) fn delimiter(&self) -> Delimiter {
        self.layout.delimiter
    }

    /// Examines the end of the text that holds the next lines.
    pub(crate) fn look_at_the_end(&mut self, text: &str) {
        self.last_is_cut = last_number_is_cut(text, self.layout.delimiter);
    }

    /// Reads the values of a line, each into its slot: NaN where one is missing or has no column. Returns
    /// `false` where the line is empty or was cut off.
    pub(crate) fn read(&mut self, line: Line<'_>, values: &mut [f64]) -> Checked<bool> {
        if line.is_void() || !self.is_asked(line) {
            return Ok(false);
        }
        self.rows += 1;
        let read = self.values(line, values);
        if read.is_err() {
            line.check_ends()?;
        }
        match read {
            // the last line may end anywhere when a logger was switched off
            _ if !line.terminated && self.rows > 1 && self.is_cut(line) => {
                self.truncated = Some(line.number);
                return Ok(false);
            }
            Err(error) if !line.terminated && self.rows > 1 && error.cut => {
                self.truncated = Some(line.number);
                return Ok(false);
            }
            done => done.map_err(|error| error.input_error)?,
        }
        self.width = match self.width {
            Width::Unknown => Width::Fixed(line.text.len()),
            Width::Fixed(width) if width != line.text.len() => Width::Varies,
            width => width,
        };
        Ok(true)
    }

    /// Is it one of the rows to read?
    fn is_asked(&self, line: Line<'_>) -> bool {
        let field =
            |column: usize| line.fields(self.layout.delimiter).nth(column).map(|(_, field)| field.trim());
        self.layout.only.as_ref().is_none_or(|(column, value)| field(*column) == Some(value.as_str()))
    }

    /// Returns an error at the first invalid reading where they are too many to be a few bad samples. To be
    /// called after the last row.
    pub(crate) fn check_invalid(&mut self) -> Checked<()> {
        match self.invalid.1.take() {
            Some(input_error) if Sense::is_lost(self.invalid.0, self.rows) => Err(input_error),
            _ => Ok(()),
        }
    }

    /// Is this last line known to be cut off? Or is it shorter than all rows before, which have the same
    /// length (numbers in columns)?
    fn is_cut(&self, line: Line<'_>) -> bool {
        self.last_is_cut
            || (self.layout.delimiter == Delimiter::Whitespace
                && matches!(self.width, Width::Fixed(width) if self.rows > 3 && line.text.len() < width))
    }

    fn values(&mut self, line: Line<'_>, values: &mut [f64]) -> Result<(), RowError> {
        let layout = self.layout;
        values.fill(f64::NAN);
        let mut fields = 0;
        let mut last_is_empty = false;
        let mut row = line.fields(layout.delimiter);
        while let Some((offset, field, plain)) = row.next_number() {
            if let Some(Some(slot)) = layout.slots.get(fields).copied() {
                let is_tick = slot == 0 && layout.ticks;
                match if is_tick { self.tick(field) } else { plain.or_else(|| self.number(field)) } {
                    Some(value) if value.is_nan() => (),
                    Some(value) if is_tick && value.is_finite() => values[slot] = value,
                    Some(value) => match Sense::of(value, layout.may_be_invalid.contains(&slot)) {
                        Sense::Some => values[slot] = value,
                        Sense::Invalid => {
                            values[slot] = value;
                            self.invalid.0 += 1;
                            if self.invalid.1.is_none() {
                                self.invalid.1 =
                                    Some(self.out_of_range(field, fields, line, offset).input_error);
                            }
                        }
                        Sense::None => return Err(self.out_of_range(field, fields, line, offset)),
                    },
                    None => return Err(self.not_a_number(field, fields, line, offset)),
                }
            }
            fields += 1;
            last_is_empty = field.is_empty();
        }
        let columns = layout.slots.len();
        // a delimiter at the end of the line is no column
        if fields == columns || (fields == columns + 1 && last_is_empty) {
            return Ok(());
        }
        let help = if fields < columns {
            "was the line cut off, or written while the file was read?"
        } else {
            "numbers need a decimal point, not a comma; columns need one delimiter, and a name each: R writes row names without one (row.names = FALSE)"
        };
        let before = if layout.has_header { "the header" } else { "the first row" };
        let message = format!("{fields} columns where {before} has {columns}");
        Err(RowError {
            input_error: InputError::new(Refusal::RowMalformed, message, help).at_line(line.number).into(),
            cut: fields < columns,
        })
    }

    /// Ticks of a clock, less the first where they are too large to be exact.
    fn tick(&mut self, field: &str) -> Option<f64> {
        let whole = match self.layout.text_times {
            true => TextTime::parse(field).map(|time| time.ns),
            false => field.parse::<i64>().ok(),
        };
        let Some(ticks) = whole else {
            let origin = self.origin.unwrap_or(0);
            return self.number(field).map(|value| if origin == 0 { value } else { value - origin as f64 });
        };
        let origin = *self.origin.get_or_insert(if ticks.unsigned_abs() > EXACT { ticks } else { 0 });
        Some((i128::from(ticks) - i128::from(origin)) as f64)
    }

    fn number(&self, field: &str) -> Option<f64> {
        let with_point = || field.replacen(',', ".", 1).parse().ok();
        number(field).or_else(|| with_point().filter(|_| self.layout.decimal_comma))
    }

    fn out_of_range(&self, field: &str, column: usize, line: Line<'_>, offset: usize) -> RowError {
        let is_time = self.layout.slots.get(column) == Some(&Some(0));
        let help = match (is_time, self.layout.ticks) {
            (true, false) => "times are in seconds",
            (true, true) => "times are whole numbers",
            (false, _) => "is the unit right? is the file damaged?",
        };
        let message = format!("{} in {} is out of range", quote(field), self.layout.name(column));
        let input_error = InputError::new(Refusal::ValueOutOfRange, message, help)
            .at_line(line.number)
            .at_column(line.column(offset));
        RowError { input_error: input_error.into(), cut: false }
    }

    fn not_a_number(&self, field: &str, column: usize, line: Line<'_>, offset: usize) -> RowError {
        let is_name = |name: &String| field.eq_ignore_ascii_case(name);
        let help = if field.contains(',') {
            "numbers need a decimal point, not a comma"
        } else if self.rows > 1 && self.layout.names.get(column).is_some_and(is_name) {
            "a second header: are these files put together? keep one of them"
        } else {
            "numbers look like 9.81 or 1e-3; a missing value is an empty field or NaN"
        };
        let message = format!("{} in {} is not a number", quote(field), self.layout.name(column));
        let input_error = InputError::new(Refusal::NumberMalformed, message, help)
            .at_line(line.number)
            .at_column(line.column(offset));
        RowError {
            input_error: input_error.into(),
            cut: offset + field.len() >= line.text.trim_ascii_end().len(),
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
