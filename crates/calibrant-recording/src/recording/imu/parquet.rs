//! Reads Parquet files: columns named as in CSV, numbers of any width, whole or decimal, times as numbers or time stamps.

use super::column::ColumnMeaning;
use super::column_values::{SLOTS, Samples, TIME};
use super::file_layout::Draft;
use super::format::FileFormat;
use super::parquet_pages::Pages;
use super::parquet_type::{LIST, Whole, check_numbers, describe, time};
use crate::files::guarded_parquet::{check_compression, damaged, guarded};
use crate::recording::text_times::DAY_NS;
use crate::recording::time_unit::TimeUnit;
use crate::text::decoding::{Checked, refuse};
use bytes::Bytes;
use calibrant_core::budget::Budget;
use calibrant_core::error::{InputError, Refusal};
use parquet::basic::Type;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::data_type::DataType;
use parquet::file::metadata::RowGroupMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};

/// Number of values that are read at once.
const BATCH: usize = 1 << 16;
/// Whole numbers above this are not exact as `f64`.
const EXACT: u128 = 1 << 53;

/// An opened file and the meaning of its columns.
pub(super) struct Opened {
    reader: SerializedFileReader<Bytes>,
    pub(super) draft: Draft,
}

/// Reads the names of the columns.
pub(super) fn open(bytes: &[u8]) -> Checked<Opened> {
    guarded(|| {
        let reader =
            SerializedFileReader::new(Bytes::copy_from_slice(bytes)).map_err(|error| damaged(&error))?;
        let columns =
            reader.metadata().file_metadata().schema_descr().columns().iter().map(|column| describe(column));
        let draft = Draft::new(FileFormat::Parquet, columns.collect());
        Ok(Opened { reader, draft })
    })
}

/// Reads the values of the columns that have a slot. A few bytes can state billions of equal values, so the
/// budget is that of the rows and of the unpacked columns.
pub(super) fn samples(file: &Opened, slots: &[Option<usize>], budget: Budget) -> Checked<Samples> {
    guarded(|| {
        let rows = stated_rows(file);
        check(file, slots, rows, budget)?;
        let mut columns: [Vec<f64>; SLOTS] = Default::default();
        let mut origin = 0;
        for (at, slot) in slots.iter().enumerate().filter_map(|(at, slot)| Some((at, (*slot)?))) {
            let descriptor = file.reader.metadata().file_metadata().schema_descr().column(at);
            check_numbers(&descriptor, slot == TIME)?;
            let mut column = Column {
                name: &file.draft.columns[at].name,
                is_time: slot == TIME,
                whole: Whole::of(&descriptor),
                origin: None,
                values: Vec::new(),
                most: rows,
            };
            let least = match descriptor.physical_type() {
                Type::FIXED_LEN_BYTE_ARRAY => usize::try_from(descriptor.type_length()).unwrap_or(0).max(1),
                _ => 4,
            };
            for group in 0..file.reader.num_row_groups() {
                let group = file.reader.get_row_group(group).map_err(|error| damaged(&error))?;
                check_compression(group.metadata().column(at))?;
                let pages = group.get_column_page_reader(at).map_err(|error| damaged(&error))?;
                let pages = Pages { pages, least };
                column.read(get_column_reader(descriptor.clone(), Box::new(pages)))?;
            }
            if slot == TIME {
                origin = column.origin.unwrap_or(0);
            }
            columns[slot] = column.values;
        }
        Samples::from_columns(columns, origin)
    })
}

impl Opened {
    /// A time of day begins anew at midnight.
    pub(super) fn find_midnight(&mut self) {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        let is_clock = |at: &usize| {
            let column = &self.draft.columns[*at];
            column.meaning == ColumnMeaning::Time && column.is_used()
        };
        let unit = (0..self.draft.columns.len()).filter(is_clock).find_map(|at| time(&schema.column(at)));
        if let Some((unit, true)) = unit {
            let per_ns = TimeUnit::per_second(unit).map_or(1.0, |per_second| per_second / 1e9);
            self.draft.time_wraps_at = Some(DAY_NS * per_ns);
        }
    }

    /// The error where no column is of a sensor, and some hold lists.
    pub(super) fn with_lists(&self, mut input_error: Box<InputError>) -> Box<InputError> {
        let is_list = |at: &usize| self.draft.columns[*at].unused.as_deref() == Some(LIST);
        let list = (0..self.draft.columns.len()).find(is_list);
        if let Some(list) = list.filter(|_| input_error.code == Refusal::ColumnMissing) {
            let schema = self.reader.metadata().file_metadata().schema_descr();
            let path = schema.column(list);
            let parts = path.path().parts().iter().map(String::as_str).take_while(|part| *part != "list");
            let name = parts.collect::<Vec<_>>().join(".");
            input_error.help = format!(
                "`{name}` holds a list in each row: write a column for each axis, in SQL \"{name}\"[1] AS ax_mps2, \"{name}\"[2] AS ay_mps2, …"
            );
        }
        input_error
    }
}

/// The number of rows that the file states.
fn stated_rows(file: &Opened) -> usize {
    file.reader
        .metadata()
        .row_groups()
        .iter()
        .map(|group| usize::try_from(group.num_rows()).unwrap_or(0))
        .sum()
}

/// Checks that the columns with a slot fit into the budget: as they are stored, and as numbers of a recording.
fn check(file: &Opened, slots: &[Option<usize>], rows: usize, budget: Budget) -> Checked<()> {
    /// Bytes for each number: in its column, in its sensor, and in what is made of it.
    const NUMBER: f64 = 24.0;
    let used = || slots.iter().enumerate().filter(|(_, slot)| slot.is_some());
    let groups = file.reader.metadata().row_groups();
    let unpacked = |group: &RowGroupMetaData| -> i64 {
        used().map(|(at, _)| group.column(at).uncompressed_size().max(0)).fold(0, i64::saturating_add)
    };
    let numbers = rows as f64 * used().count() as f64;
    let bytes = NUMBER * numbers + groups.iter().map(unpacked).max().unwrap_or(0) as f64;
    let what = format!("a file of {:.1e} rows", rows as f64);
    let work = Budget { bytes, seconds: 1e-7 * numbers };
    budget.check(work, &what, "split it")
}

/// A column that is being read.
struct Column<'n> {
    name: &'n str,
    is_time: bool,
    whole: Whole,
    /// The number that is subtracted from times that are too large to be exact as `f64`.
    origin: Option<i64>,
    values: Vec<f64>,
    /// The number of rows that the file states.
    most: usize,
}

impl Column<'_> {
    fn read(&mut self, reader: ColumnReader) -> Checked<()> {
        let whole = self.whole;
        match reader {
            ColumnReader::DoubleColumnReader(reader) => self.take(reader, |_, value| *value),
            ColumnReader::FloatColumnReader(reader) => self.take(reader, |_, value| f64::from(*value)),
            ColumnReader::Int32ColumnReader(reader) => {
                self.take(reader, |column, value| column.number(whole.of_i32(*value)))
            }
            ColumnReader::Int64ColumnReader(reader) => {
                self.take(reader, |column, value| column.number(whole.of_i64(*value)))
            }
            ColumnReader::Int96ColumnReader(reader) => {
                self.take(reader, |column, value| column.number(value.to_nanos().into()))
            }
            ColumnReader::ByteArrayColumnReader(reader) => {
                self.take(reader, |_, value| whole.of_bytes(value.data()))
            }
            ColumnReader::FixedLenByteArrayColumnReader(reader) => {
                self.take(reader, |_, value| whole.of_bytes(value.data()))
            }
            ColumnReader::BoolColumnReader(reader) => self.take(reader, |_, _| f64::NAN), // was refused by its type
        }
    }

    /// The number of a whole one; ticks of a clock that are too large to be exact are counted from the first.
    fn number(&mut self, value: i128) -> f64 {
        if !self.is_time || self.whole.scale.is_some() {
            return self.whole.number(value);
        }
        let first = || i64::try_from(value).ok().filter(|_| value.unsigned_abs() > EXACT).unwrap_or(0);
        let origin = *self.origin.get_or_insert_with(first);
        (value - i128::from(origin)) as f64
    }

    fn take<T: DataType>(
        &mut self,
        mut reader: ColumnReaderImpl<T>,
        number: impl Fn(&mut Self, &T::T) -> f64,
    ) -> Checked<()> {
        loop {
            let (mut present, mut found) = (Vec::new(), Vec::new());
            let (rows, values, _) = reader
                .read_records(BATCH, Some(&mut present), None, &mut found)
                .map_err(|error| damaged(&error))?;
            if rows == 0 {
                return Ok(());
            }
            if self.values.len() + rows > self.most {
                let message = format!("column `{}` has more rows than the file states", self.name);
                return refuse(Refusal::FileDamaged, message, "was it written to its end?");
            }
            // where every value is there, there are no levels
            let all = values == rows;
            let most = present.iter().copied().max().unwrap_or(0);
            let mut found = found.iter();
            for row in 0..rows {
                let is_there = all || present.get(row).is_some_and(|level| *level == most && most > 0);
                let value = if is_there { found.next() } else { None };
                let value = value.map_or(f64::NAN, |value| number(self, value));
                self.values.push(value);
            }
        }
    }
}
