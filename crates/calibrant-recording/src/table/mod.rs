//! Tables of columns for other programs: CSV, or Parquet, as the ending of the file's name says.

mod columns;
mod csv;
mod format;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(feature = "parquet")]
mod parquet_rows;
mod write;

pub use columns::{ColumnValues, Table, TableColumn};
pub use csv::spreadsheet_text;
pub use format::TableFormat;
#[cfg(feature = "parquet")]
pub use parquet_rows::ParquetRows;
