//! Writes a table in the format that its name says.

use super::columns::Table;
use super::csv;
use super::format::TableFormat;
#[cfg(feature = "parquet")]
use super::parquet;
use crate::files::atomic_output::write_atomically;
use calibrant_core::error::Result;
use std::path::Path;

impl Table {
    /// Writes the table. A number has the fewest digits that read back to the same bits, a text of CSV that begins like a formula an apostrophe before it.
    ///
    /// # Errors
    /// As [`TableFormat::of`]; [`Error::Output`](calibrant_core::Error::Output) where the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        let format = TableFormat::of(path)?;
        write_atomically(path, |out| match format {
            TableFormat::Csv => csv::write(self, out),
            #[cfg(feature = "parquet")]
            // Parquet wants to send its writer to other threads, so the file is made in memory
            TableFormat::Parquet => out.write_all(&parquet::bytes(self).map_err(std::io::Error::other)?),
            #[cfg(not(feature = "parquet"))]
            TableFormat::Parquet => Err(std::io::ErrorKind::Unsupported.into()),
        })
    }
}
