//! The formats of a table, and its CSV: one row for each calibration.

use super::table::Table;
use crate::database::{RecordFilter, Records};
use calibrant_core::error::Result;
use calibrant_io::{spreadsheet_text, write_atomically};
use std::io;
use std::path::Path;

/// The format of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportFormat {
    /// Comma-separated text.
    Csv,
    /// Apache Parquet.
    Parquet,
}

impl ExportFormat {
    /// The format that the ending of a name says; `None` for another ending.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "csv" => Some(Self::Csv),
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }
}

impl Records {
    /// Writes the records of a filter as a table: where each calibration comes from, its verdict, and value and standard deviation of each parameter, with units in
    /// the names of the columns. Gives the number of rows.
    ///
    /// # Errors
    /// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written. [`Error::Experiment`](calibrant_core::Error::Experiment) where the records are damaged, or where this build writes no Parquet.
    pub fn export(&self, path: &Path, format: ExportFormat, filter: &RecordFilter) -> Result<usize> {
        let mut table = Table::default();
        self.each(filter, |kept| table.add(&kept))?;
        match format {
            ExportFormat::Csv => write_as_csv(path, &table)?,
            ExportFormat::Parquet => write_parquet(path, &table)?,
        }
        Ok(table.ids.len())
    }
}

#[cfg(feature = "parquet")]
fn write_parquet(path: &Path, table: &Table) -> Result<()> {
    super::parquet::write(path, table)
}

#[cfg(not(feature = "parquet"))]
fn write_parquet(path: &Path, _: &Table) -> Result<()> {
    use calibrant_core::error::{Error, InputError, Refusal};
    let error = InputError::new(Refusal::FormatUnsupported, "this build writes no Parquet", "export CSV");
    Err(Error::experiment(error.in_file(path)))
}

fn write_as_csv(path: &Path, table: &Table) -> Result<()> {
    write_atomically(path, |out| {
        let mut out = csv::Writer::from_writer(out);
        let names = table
            .texts
            .iter()
            .map(|(name, _)| *name)
            .chain(table.numbers.iter().map(|(name, _)| name.as_str()));
        out.write_record(std::iter::once("id").chain(names)).map_err(io::Error::other)?;
        for (row, id) in table.ids.iter().enumerate() {
            out.write_field(id.to_string()).map_err(io::Error::other)?;
            for (_, column) in &table.texts {
                out.write_field(spreadsheet_text(column[row].as_deref().unwrap_or_default()))
                    .map_err(io::Error::other)?;
            }
            for (_, column) in &table.numbers {
                let text = column[row].map_or_else(String::new, |number| format!("{number:?}"));
                out.write_field(text).map_err(io::Error::other)?;
            }
            out.write_record(None::<&[u8]>).map_err(io::Error::other)?;
        }
        out.flush()
    })
}
