//! Writes records as a table: one row for each calibration.

use super::columns::Columns;
use crate::database::{RecordFilter, Records};
use calibrant_core::error::Result;
use std::path::Path;

impl Records {
    /// Writes the records of a filter as a [table](calibrant_io::Table), CSV or Parquet: where each calibration comes from, its verdict, and value and standard deviation of
    /// each parameter, with units in the names of the columns. Gives the number of rows.
    ///
    /// # Errors
    /// As [`Table::write`](calibrant_io::Table::write). [`Error::Experiment`](calibrant_core::Error::Experiment) where the records are damaged.
    pub fn export(&self, path: &Path, filter: &RecordFilter) -> Result<usize> {
        let mut columns = Columns::default();
        self.each(filter, |kept| columns.add(&kept))?;
        let rows = columns.rows();
        columns.into_table().write(path)?;
        Ok(rows)
    }
}
