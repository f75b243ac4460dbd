//! Reads a table of Parquet by rows: each is an object of its columns.

use crate::files::guarded_parquet::{check_compression, damaged, guarded};
use crate::files::parquet_decimal::{big_endian, decimal};
use crate::text::decoding::{Checked, open_file};
use calibrant_core::error::{Error, Result};
use parquet::file::metadata::RowGroupMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::reader::RowIter;
use parquet::record::{Field, Row};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The rows of a file of Parquet, one after the other.
pub struct ParquetRows {
    rows: RowIter<'static>,
    path: PathBuf,
}

impl ParquetRows {
    /// Opens a file.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the file cannot be opened, is no Parquet, or is compressed as nothing here reads it.
    pub fn open(path: &Path) -> Result<Self> {
        let opened = open_file(path, "a data set").map_err(Error::Experiment)?;
        let rows = guarded(|| {
            let reader = SerializedFileReader::new(opened).map_err(|error| damaged(&error))?;
            reader
                .metadata()
                .row_groups()
                .iter()
                .flat_map(RowGroupMetaData::columns)
                .try_for_each(check_compression)?;
            Ok(RowIter::from_file_into(Box::new(reader)))
        });
        let rows = rows.map_err(|error| Error::experiment(error.in_file(path)))?;
        Ok(Self { rows, path: path.to_path_buf() })
    }

    /// The next rows, at most `most` of them. There are none at the end of the file. A number that is not finite is missing.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the file is damaged.
    pub fn next_rows(&mut self, most: usize) -> Result<Vec<Value>> {
        let rows = &mut self.rows;
        let read = guarded(|| rows.take(most).map(object).collect::<Checked<Vec<_>>>());
        read.map_err(|error| Error::experiment(error.in_file(&self.path)))
    }
}

fn object(row: parquet::errors::Result<Row>) -> Checked<Value> {
    let columns = row.map_err(|error| damaged(&error))?.into_columns();
    Ok(Value::Object(columns.into_iter().map(|(name, field)| (name, value(&field))).collect()))
}

fn value(field: &Field) -> Value {
    match field {
        Field::Bool(of) => (*of).into(),
        Field::Byte(of) => (*of).into(),
        Field::Short(of) => (*of).into(),
        Field::Int(of) => (*of).into(),
        Field::Long(of) => (*of).into(),
        Field::UByte(of) => (*of).into(),
        Field::UShort(of) => (*of).into(),
        Field::UInt(of) => (*of).into(),
        Field::ULong(of) => (*of).into(),
        Field::Float(of) => f64::from(*of).into(),
        Field::Double(of) => (*of).into(),
        Field::Decimal(of) => big_endian(of.data()).map(|whole| decimal(whole, of.scale())).into(),
        Field::Str(of) => of.as_str().into(),
        Field::ListInternal(list) => list.elements().iter().map(value).collect(),
        _ => Value::Null,
    }
}
