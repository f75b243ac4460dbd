//! The data set of a fleet: a table of Parquet in parts, with a row for each recording.

#[cfg(feature = "parquet")]
mod import;
#[cfg(feature = "parquet")]
mod part;
mod row;

#[cfg(feature = "parquet")]
pub use import::Imported;
pub use row::DatasetRow;
