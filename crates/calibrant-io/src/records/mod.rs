//! Records: the calibrations of many sensors over the years, in one SQLite database.
//!
//! [`Record`] is what a database keeps of a `calibration.json`: sensor, date, station, hashes of experiment and recordings, version of the program,
//! verdict, parameters and their covariance. `Records` is the database (feature `records`).
//!
//! # Tables
//! | table or view | a row is |
//! |---|---|
//! | `calibrations` | a calibration: where it comes from, its verdict, its covariance (the lower triangle by rows, `f64`, little endian) |
//! | `parameters` | one parameter of a calibration: value and standard deviation |
//! | `models`, `names` | a set of parameters that calibrations share; name and unit of each |
//! | `estimates` (view) | one parameter with its name, sensor and date: for questions in SQL |
//! | `latest` (view) | the calibrations without those that a later one of the same recording replaces |
//!
//! Values stand in rows, so that SQL finds them. A covariance is only of use as a whole, and takes half of the space as one blob.
//!
//! Recording, experiment, motion and program tell a calibration from others: the same again takes its place. A recording is of one sensor: a copy under the name of another is
//! refused.
//!
//! # Several writers
//! Each calibration is one transaction, and a writer waits up to a minute for another. The journal is SQLite's rollback journal, not its write-ahead log: the
//! database is then one file, and it may lie on a network drive whose locks work. A process that is killed leaves the calibrations that it finished.
//!
//! # Versions
//! `user_version` is the version of the schema, and `application_id` says that the file is ours. An older schema is brought up to date when it is opened; a newer one is
//! refused.

#[cfg(feature = "records")]
mod database;
#[cfg(feature = "records")]
mod drift;
#[cfg(feature = "records")]
mod export;
#[cfg(all(feature = "records", feature = "parquet"))]
mod export_parquet;
#[cfg(feature = "records")]
mod export_table;
#[cfg(feature = "records")]
mod failure;
#[cfg(feature = "records")]
mod fleet;
#[cfg(feature = "records")]
mod fleet_frame;
#[cfg(feature = "records")]
mod history;
#[cfg(feature = "records")]
mod json;
#[cfg(feature = "records")]
mod model;
#[cfg(feature = "records")]
mod query;
mod record;
#[cfg(feature = "records")]
mod repeated_recording;
#[cfg(feature = "records")]
mod schema;
#[cfg(feature = "records")]
mod writable;

#[cfg(feature = "records")]
pub use database::{Inserted, Records};
#[cfg(feature = "records")]
pub use drift::SensorDrift;
#[cfg(feature = "records")]
pub use export::ExportFormat;
#[cfg(feature = "records")]
pub use fleet::{Fleet, FleetParameter, LeftOut};
#[cfg(feature = "records")]
pub use history::{SensorChange, SensorHistory};
#[cfg(feature = "records")]
pub use json::{drifts_json, fleet_json, history_json, record_json, records_json};
#[cfg(feature = "records")]
pub use query::{KeptRecord, RecordFilter};
pub use record::Record;
#[cfg(all(test, feature = "records"))]
mod fleet_tests;
#[cfg(all(test, feature = "records"))]
mod large_tests;
#[cfg(all(test, feature = "records"))]
mod refusal_tests;
#[cfg(all(test, feature = "records"))]
mod tests;
#[cfg(all(test, feature = "records"))]
mod version_tests;
