//! The table of records as a Parquet file. Every column but `id` is optional.

use super::table::Table;
use calibrant_core::error::Result;
use calibrant_io::{program, write_atomically};
use parquet::basic::{Compression, LogicalType, Repetition, Type as PhysicalType};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result as Parquet};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// Writes the table.
pub(super) fn write(path: &Path, table: &Table) -> Result<()> {
    // Parquet wants to send its writer to other threads, so the file is made in memory
    write_atomically(path, |out| out.write_all(&bytes(table).map_err(io::Error::other)?))
}

fn bytes(table: &Table) -> Parquet<Vec<u8>> {
    let properties =
        WriterProperties::builder().set_created_by(program()).set_compression(Compression::SNAPPY).build();
    let mut bytes = Vec::new();
    let mut file = SerializedFileWriter::new(&mut bytes, schema(table)?, Arc::new(properties))?;
    let mut rows = file.next_row_group()?;
    column::<Int64Type, _>(&mut rows, &table.ids, None)?;
    for (_, texts) in &table.texts {
        let there: Vec<ByteArray> = texts.iter().flatten().map(|text| text.as_str().into()).collect();
        column::<ByteArrayType, _>(&mut rows, &there, Some(&levels(texts)))?;
    }
    for (_, numbers) in &table.numbers {
        let there: Vec<f64> = numbers.iter().flatten().copied().collect();
        column::<DoubleType, _>(&mut rows, &there, Some(&levels(numbers)))?;
    }
    rows.close()?;
    file.close()?;
    Ok(bytes)
}

/// For each entry: is it there?
fn levels<T>(column: &[Option<T>]) -> Vec<i16> {
    column.iter().map(|entry| i16::from(entry.is_some())).collect()
}

fn column<D: DataType, W: Write + Send>(
    rows: &mut SerializedRowGroupWriter<'_, W>,
    values: &[D::T],
    levels: Option<&[i16]>,
) -> Parquet<()> {
    let mut column = rows.next_column()?.ok_or_else(|| ParquetError::General("too few columns".into()))?;
    column.typed::<D>().write_batch(values, levels, None)?;
    column.close()
}

fn schema(table: &Table) -> Parquet<Arc<Type>> {
    let field = |name: &str, of: PhysicalType, repetition, logical| {
        let builder =
            Type::primitive_type_builder(name, of).with_repetition(repetition).with_logical_type(logical);
        builder.build().map(Arc::new)
    };
    let mut fields = vec![field("id", PhysicalType::INT64, Repetition::REQUIRED, None)?];
    for (name, _) in &table.texts {
        fields.push(field(name, PhysicalType::BYTE_ARRAY, Repetition::OPTIONAL, Some(LogicalType::String))?);
    }
    for (name, _) in &table.numbers {
        fields.push(field(name, PhysicalType::DOUBLE, Repetition::OPTIONAL, None)?);
    }
    Type::group_type_builder("calibrations").with_fields(fields).build().map(Arc::new)
}
