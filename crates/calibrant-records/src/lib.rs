//! Records: the calibrations of many sensors over the years, in one SQLite database; what a sensor does over them, and how the sensors differ.
//!
//! [`Record`] is what a database keeps of a `calibration.json`: sensor, date, station, hashes of experiment and recordings, version of the program,
//! verdict, parameters and their covariance. [`Records`] is the database.
//!
//! A fleet is calibrated into a Parquet data set, a [`DatasetRow`] for each recording. Records take it up.
//!
//! Two calibrations of one sensor are compared by [`Comparison`](calibrant_core::estimate::Comparison). Several show its [`Aging`]: a line over time through each quantity that
//! does not depend on the true frame. A [`Distribution`] says how a quantity differs from sensor to sensor.
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
//! `user_version` is the version of the schema, and `application_id` says that the file is ours. Another version is refused.

mod aging;
mod database;
mod dataset;
mod export;
mod fleet;
mod json;
mod model;
mod record;
mod sheet;

pub use aging::{
    Aging, Dated, DatedCalibration, QuantityAging, SensorChange, SensorDrift, SensorHistory, aging_of,
};
pub use database::{Inserted, KeptRecord, RecordFilter, Records};
pub use dataset::DatasetRow;
#[cfg(feature = "parquet")]
pub use dataset::{DataSet, Imported};
pub use fleet::{Distribution, FarSensor, Fleet, FleetParameter, LeftOut};
pub use json::RecordFile;
pub use record::{KeptVerdict, Record};
pub use sheet::{drift_sheet, fleet_sheet, history_sheet, record_sheet, records_sheet};

#[cfg(all(test, feature = "parquet"))]
mod dataset_tests;
#[cfg(test)]
mod fleet_tests;
#[cfg(test)]
mod large_tests;
#[cfg(test)]
mod refusal_tests;
#[cfg(test)]
mod shared_error_tests;
#[cfg(test)]
mod tests;
