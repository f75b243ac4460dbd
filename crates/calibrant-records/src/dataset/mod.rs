//! The data set of a fleet: a table of Parquet in parts, with a row for each recording.

#[cfg(feature = "parquet")]
mod data_set;
#[cfg(feature = "parquet")]
mod import;
mod row;

#[cfg(feature = "parquet")]
pub use data_set::DataSet;
#[cfg(feature = "parquet")]
pub use import::Imported;
pub use row::DatasetRow;
