//! Recordings: delimited text in many dialects, read in one pass, checked row by row and as a whole.
//!
//! | content | recognised by |
//! |---|---|
//! | `t_s,ax,ay,az`, axes optionally ending in `_mps2`, `_counts`, `_g` | its header |
//! | `t x y z` (imu_tk's `.mat` files and many others) | a first row of numbers |
//!
//! Every other format is that of a whole IMU (`imu/`). [`read_accelerometer`] takes its accelerometer alone.
//!
//! Delimiters: comma, semicolon, tab or white space, found in the first line. Comment lines (`#`, `//`, `%`),
//! blank lines, a byte order mark and line ends of any system are fine. The reader repairs what it can and
//! reports it as a [`Finding`]. What would change the answer unnoticed is an error.

mod checksum;
mod chunked_reader;
mod columns;
mod file;
mod finding_words;
mod imu;
mod lost_sign;
mod options;
mod read;
mod reader_finding;
mod recording_quality;
mod recording_writer;
mod row_parser;
mod row_reader;
mod size;

pub use file::RecordingFile;
pub use imu::{
    ColumnMapping, ColumnMeaning, ColumnUnit, FileFormat, ImuColumn, ImuFile, ImuReadOptions, ImuUnit,
    SecondFile, TimeUnit, parse_imu_pair, parse_imu_recording, read_accelerometer, read_imu_pair,
    read_imu_recording, read_imu_sensor,
};
pub use options::ReadOptions;
pub use read::{parse_recording, read_recording};
pub use reader_finding::{Finding, Noticed};
pub use recording_writer::{write_imu_recording, write_recording};
