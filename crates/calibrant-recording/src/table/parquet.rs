//! A table as a Parquet file. Only columns of whole numbers are not optional.

use super::columns::{ColumnValues, Table};
use crate::files::program::program;
use parquet::basic::{Compression, LogicalType, Repetition, Type as PhysicalType};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io::Write;
use std::sync::Arc;

/// The content of the file.
pub(super) fn bytes(table: &Table) -> Result<Vec<u8>> {
    let properties =
        WriterProperties::builder().set_created_by(program()).set_compression(Compression::SNAPPY).build();
    let mut bytes = Vec::new();
    let mut file = SerializedFileWriter::new(&mut bytes, schema(table)?, Arc::new(properties))?;
    let mut rows = file.next_row_group()?;
    for column in &table.columns {
        match &column.values {
            ColumnValues::Whole(numbers) => write::<Int64Type, _>(&mut rows, numbers, None)?,
            ColumnValues::Numbers(numbers) => {
                let (there, levels) =
                    present(numbers.iter().map(|number| Some(*number).filter(|n| !n.is_nan())));
                write::<DoubleType, _>(&mut rows, &there, Some(&levels))?;
            }
            ColumnValues::Texts(texts) => {
                let (there, levels) = present(texts.iter().map(|text| text.as_deref().map(ByteArray::from)));
                write::<ByteArrayType, _>(&mut rows, &there, Some(&levels))?;
            }
        }
    }
    rows.close()?;
    file.close()?;
    Ok(bytes)
}

/// The entries that are there, and for each row whether it has one.
fn present<T>(entries: impl Iterator<Item = Option<T>>) -> (Vec<T>, Vec<i16>) {
    let mut there = Vec::new();
    let mut levels = Vec::new();
    for entry in entries {
        levels.push(i16::from(entry.is_some()));
        there.extend(entry);
    }
    (there, levels)
}

fn write<D: DataType, W: Write + Send>(
    rows: &mut SerializedRowGroupWriter<'_, W>,
    values: &[D::T],
    levels: Option<&[i16]>,
) -> Result<()> {
    let mut column = rows.next_column()?.ok_or_else(|| ParquetError::General("too few columns".into()))?;
    column.typed::<D>().write_batch(values, levels, None)?;
    column.close()
}

fn schema(table: &Table) -> Result<Arc<Type>> {
    let field = |(name, values): (&str, &ColumnValues)| {
        let (of, repetition, logical) = match values {
            ColumnValues::Whole(_) => (PhysicalType::INT64, Repetition::REQUIRED, None),
            ColumnValues::Numbers(_) => (PhysicalType::DOUBLE, Repetition::OPTIONAL, None),
            ColumnValues::Texts(_) => {
                (PhysicalType::BYTE_ARRAY, Repetition::OPTIONAL, Some(LogicalType::String))
            }
        };
        let builder =
            Type::primitive_type_builder(name, of).with_repetition(repetition).with_logical_type(logical);
        builder.build().map(Arc::new)
    };
    let columns = table.columns.iter().map(|column| field((&column.name, &column.values)));
    let fields = columns.collect::<Result<Vec<_>>>()?;
    Type::group_type_builder(table.name).with_fields(fields).build().map(Arc::new)
}
