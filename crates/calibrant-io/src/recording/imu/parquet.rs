//! Reads Parquet files: columns named as in CSV, numbers of any width, times as numbers or time stamps.

use super::column::{ColumnMeaning, ImuColumn};
use super::column_names;
use super::column_values::{SLOTS, Samples, TIME};
use super::file_layout::Draft;
use super::format::FileFormat;
use super::parquet_pages::Pages;
use super::unit::ColumnUnit;
use crate::files::guarded_parquet::{damaged, guarded};
use crate::recording::time_unit::TimeUnit;
use crate::text::decoding::{Checked, refuse};
use bytes::Bytes;
use calibrant_core::budget::Budget;
use calibrant_core::error::Refusal;
use parquet::basic::{Compression, LogicalType, TimeUnit as StampUnit};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
use parquet::data_type::DataType;
use parquet::file::metadata::RowGroupMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

/// Number of values that are read at once.
const BATCH: usize = 1 << 16;
/// Whole numbers above this are not exact as `f64`.
const EXACT: u64 = 1 << 53;

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

/// A column: its name as in CSV, and the unit of a time stamp from its type.
fn describe(column: &ColumnDescriptor) -> ImuColumn {
    let name = column.path().string();
    if column.max_rep_level() > 0 {
        let mut described = ImuColumn::new(&name, ColumnMeaning::Other, None);
        described.unused = Some("a list, not a number for each row".into());
        return described;
    }
    let mut described = column_names::column(&name);
    let unit = match column.logical_type_ref() {
        Some(LogicalType::Timestamp(stamp)) => match stamp.unit {
            StampUnit::MILLIS => TimeUnit::Millisecond,
            StampUnit::MICROS => TimeUnit::Microsecond,
            StampUnit::NANOS => TimeUnit::Nanosecond,
        },
        _ => return described,
    };
    // a time stamp is a time whatever its name
    described.unit = Some(ColumnUnit::Time(unit));
    if described.meaning == ColumnMeaning::Other {
        described = ImuColumn::new(&name, ColumnMeaning::Time, described.unit);
    }
    described
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
            let mut column = Column {
                name: &file.draft.columns[at].name,
                is_time: slot == TIME,
                origin: None,
                values: Vec::new(),
                most: rows,
            };
            for group in 0..file.reader.num_row_groups() {
                let group = file.reader.get_row_group(group).map_err(|error| damaged(&error))?;
                if group.metadata().column(at).compression() == Compression::LZO {
                    return refuse(
                        Refusal::FormatUnsupported,
                        "the file is compressed with LZO, which is not read",
                        "write it again with zstd, snappy or no compression",
                    );
                }
                let descriptor = file.reader.metadata().file_metadata().schema_descr().column(at);
                let pages = group.get_column_page_reader(at).map_err(|error| damaged(&error))?;
                column.read(get_column_reader(descriptor, Box::new(Pages(pages))))?;
            }
            if slot == TIME {
                origin = column.origin.unwrap_or(0);
            }
            columns[slot] = column.values;
        }
        Samples::from_columns(columns, origin)
    })
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
    /// The number that is subtracted from times that are too large to be exact as `f64`.
    origin: Option<i64>,
    values: Vec<f64>,
    /// The number of rows that the file states.
    most: usize,
}

impl Column<'_> {
    fn read(&mut self, reader: ColumnReader) -> Checked<()> {
        match reader {
            ColumnReader::DoubleColumnReader(reader) => self.take(reader, |_, value| *value),
            ColumnReader::FloatColumnReader(reader) => self.take(reader, |_, value| f64::from(*value)),
            ColumnReader::Int32ColumnReader(reader) => self.take(reader, |_, value| f64::from(*value)),
            ColumnReader::Int64ColumnReader(reader) => {
                self.take(reader, |column, value| column.whole(*value))
            }
            _ => {
                let message = format!("column `{}` does not hold numbers", self.name);
                refuse(
                    Refusal::NumberMalformed,
                    message,
                    "is it the right column? numbers are float, double, int32 or int64",
                )
            }
        }
    }

    fn whole(&mut self, value: i64) -> f64 {
        if !self.is_time {
            return value as f64;
        }
        let origin = *self.origin.get_or_insert(if value.unsigned_abs() > EXACT { value } else { 0 });
        (i128::from(value) - i128::from(origin)) as f64
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
