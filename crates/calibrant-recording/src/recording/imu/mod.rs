//! Recordings of an IMU or of an accelerometer, in the formats of many programs.
//!
//! | format | recognised by | times | units |
//! |---|---|---|---|
//! | MT Manager | comments `// Update Rate`, `// DeviceId`, … above `PacketCounter…` | `SampleTimeFine` 0.1 ms, or `PacketCounter` and the rate | m/s², rad/s |
//! | Movella DOT | `sep=`, `DeviceTag:`, … above `PacketCounter…` | `SampleTimeFine` µs | m/s², deg/s |
//! | EuRoC | `#timestamp [ns],…` | ns | m/s², rad/s |
//! | imu_tk | four columns of numbers, `t x y z`; two files | s | asked for |
//! | imucal | `n_samples,gyr_x,…` | counter; the rate is asked for | asked for |
//! | bags of ROS (MCAP, `.db3`, `.bag`) | their first bytes | `header.stamp` | m/s², rad/s |
//! | Parquet | its first bytes | by name or type | by name, or asked for |
//! | logs of PX4 and ArduPilot | their first bytes | `timestamp_sample`, `SampleUS`, … µs | m/s², rad/s |
//! | a table in memory ([`imu_from_columns`]) | – | by name | by name, or asked for |
//! | CSV | none of these | by name, or `[columns]` | by name, or asked for |
//! | plain text | `t_s,ax,ay,az`, or `t x y z`, read for the accelerometer alone | s | by name, or the experiment's |
//!
//! All formats go the same way. [`text_header`](super::text_header) finds the header. A format's own file gives the meaning of
//! its columns ([`file_layout`]). [`column_values`] reads the rows. [`sample_clock`] makes times of them, and
//! [`reading_unit`] finds the units. [`recording_assembly`] puts the recording together. The user must give a
//! unit that the file does not state; the question shows what the values suggest. The program never guesses
//! it.

mod accelerometer_only;
mod autopilot;
mod autopilot_source;
#[cfg(feature = "mcap")]
mod bag;
mod binary_columns;
mod column;
mod column_names;
mod column_values;
mod csv;
mod euroc;
mod even_times;
mod file;
mod file_layout;
mod first_rows;
mod format;
mod headerless_text;
#[cfg(feature = "mcap")]
mod imu_message;
mod imu_tk;
mod imucal;
mod in_memory;
mod instances;
mod movella_dot;
mod mt_manager;
mod names_of_file;
mod options;
mod packet_times;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(feature = "parquet")]
mod parquet_pages;
#[cfg(feature = "parquet")]
mod parquet_type;
mod read;
mod reading_unit;
mod recording_assembly;
mod sample_clock;
mod sensitivity;
mod sensor_rows;
mod two_files;
mod unit;
mod xsens;

pub use column::{ColumnMeaning, ImuColumn};
pub(crate) use column_names::column as imu_column;
pub use even_times::SampleTimes;
pub use file::{ImuFile, SecondFile};
pub use format::FileFormat;
pub use in_memory::{imu_from_columns, imu_pair_of};
pub use options::{AccelerometerOnly, ColumnMapping, ImuReadOptions, TYPED_RATE_SD_PPM, USUAL_RATE_SD_PPM};
pub use read::{parse_imu_recording, read_imu_recording, read_imu_sensor};
pub use reading_unit::check_counts;
pub use sensitivity::Sensitivity;
pub use two_files::{parse_imu_pair, read_imu_pair};
pub use unit::{ColumnUnit, ImuUnit};
