//! Tables of columns for other programs: CSV, or Parquet, as the ending of the file's name says.

mod columns;
mod csv;
mod format;
#[cfg(feature = "parquet")]
mod parquet;
mod write;

pub use columns::{ColumnValues, Table, TableColumn};
pub use format::TableFormat;
