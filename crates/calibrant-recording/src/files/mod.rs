//! Files and their places: written whole, named, recognised by their content.

pub mod atomic_output;
pub mod checksum;
pub mod file_name;
#[cfg(feature = "parquet")]
pub mod guarded_parquet;
pub mod hashed_file;
pub mod manifest;
#[cfg(feature = "parquet")]
pub mod parquet_decimal;
pub mod program;
pub mod standard_input;
pub mod utc_time;
