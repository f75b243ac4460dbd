//! Recordings: text in many dialects, and binary formats of loggers and robots, checked row by row and as a whole.
//!
//! One reader (`imu/`) serves accelerometers and whole IMUs. [`ImuReadOptions::accelerometer_only`] is for
//! experiments with one accelerometer. They also have plain texts, whose unit is that of the experiment:
//!
//! | content | recognised by |
//! |---|---|
//! | `t_s,ax,ay,az`, axes optionally ending in a unit, as `_mps2`, `_counts`, `_g` | its header |
//! | `t x y z` (imu_tk's `.mat` files and many others) | a first row of numbers |
//!
//! Delimiters: comma, semicolon, tab or white space, found in the first line. Comment lines (`#`, `//`, `%`),
//! blank lines, a byte order mark and line ends of any system are fine. The reader repairs what it can and
//! reports it as a [`Diagnostic`](calibrant_core::diagnostic::Diagnostic). What would change the answer unnoticed is an error.
//!
//! The time to read a file grows as its length does. A row of an accelerometer takes about 45 bytes of memory,
//! that of an IMU about 70. The text is read in pieces, unless its lines end with CR alone.

pub(crate) mod autopilot;
#[cfg(feature = "mcap")]
pub(crate) mod bag;
#[cfg(feature = "mcap")]
pub(crate) mod bag_file;
pub(crate) mod bag_kind;
pub(crate) mod chunked_reader;
pub(crate) mod clock_column;
pub(crate) mod corrected;
#[cfg(feature = "mcap")]
mod db3;
pub(crate) mod ferraris_sections;
mod glued_axes;
mod imu;
pub(crate) mod line_map;
mod lost_sign;
#[cfg(feature = "mcap")]
mod mcap_chunk;
#[cfg(feature = "mcap")]
mod mcap_container;
#[cfg(feature = "mcap")]
mod mcap_footer;
#[cfg(feature = "mcap")]
pub(crate) mod mcap_order;
#[cfg(feature = "mcap")]
mod mcap_records;
pub(crate) mod named_sensor;
pub(crate) mod recording_quality;
mod recording_writer;
#[cfg(feature = "mcap")]
pub(crate) mod ros_message;
#[cfg(feature = "mcap")]
mod rosbag;
pub(crate) mod row_parser;
mod size;
pub(crate) mod split_clock;
#[cfg(feature = "mcap")]
mod sqlite;
pub mod stated_rate;
pub(crate) mod tally;
pub(crate) mod text_header;
pub(crate) mod text_source;
pub(crate) mod text_times;
pub(crate) mod time_order;
pub(crate) mod time_unit;

pub(crate) use imu::imu_column;
pub use imu::{
    AccelerometerOnly, ColumnMapping, ColumnMeaning, ColumnUnit, FileFormat, ImuColumn, ImuFile,
    ImuReadOptions, ImuUnit, SampleTimes, SecondFile, Sensitivity, TYPED_RATE_SD_PPM, USUAL_RATE_SD_PPM,
    check_counts, imu_from_columns, imu_pair_of, parse_imu_pair, parse_imu_recording, read_imu_pair,
    read_imu_recording, read_imu_sensor,
};
pub use recording_writer::{write_imu_recording, write_recording};
pub use time_unit::TimeUnit;
