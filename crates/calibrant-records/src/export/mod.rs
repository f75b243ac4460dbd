//! Records as a table for other programs.

mod format;
#[cfg(feature = "parquet")]
mod parquet;
mod table;

pub use format::ExportFormat;
