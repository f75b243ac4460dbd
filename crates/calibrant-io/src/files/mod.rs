//! Files and their places: written whole, named, recognised by their content.

pub(crate) mod atomic_output;
pub(crate) mod finished;
#[cfg(feature = "parquet")]
pub(crate) mod guarded_parquet;
pub(crate) mod hashed_file;
pub(crate) mod manifest;
pub(crate) mod name_pattern;
#[cfg(feature = "parquet")]
pub(crate) mod parquet_decimal;
pub(crate) mod result_places;
pub(crate) mod resume_key;
pub(crate) mod sensor_naming;
pub(crate) mod standard_input;
pub(crate) mod utc_time;
