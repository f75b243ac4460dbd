//! Recordings of a whole IMU, in the formats of many programs.
//!
//! | format | recognised by | times | units |
//! |---|---|---|---|
//! | MT Manager | comments `// Update Rate`, `// DeviceId`, … above `PacketCounter…` | `SampleTimeFine` 0.1 ms, or `PacketCounter` and the rate | m/s², rad/s |
//! | Movella DOT | `sep=`, `DeviceTag:`, … above `PacketCounter…` | `SampleTimeFine` µs | m/s², deg/s |
//! | EuRoC | `#timestamp [ns],…` | ns | m/s², rad/s |
//! | imu_tk | four columns of numbers, `t x y z`; two files | s | asked for |
//! | imucal | `n_samples,gyr_x,…` | counter; the rate is asked for | asked for |
//! | MCAP, Parquet | their first bytes | `header.stamp`; by name or type | m/s², rad/s; by name, or asked for |
//! | CSV | none of these | by name, or `[columns]` | by name, or asked for |
//!
//! All of them go the same way: [`head`] finds the header, a format's own file says what its columns mean ([`draft`]), [`samples`] reads the rows,
//! [`clock`] makes times and [`readings`] units of them, [`assemble`] puts the recording together. A unit that the file does not state is
//! asked for, with what its values suggest; it is never guessed.

mod accelerometer;
mod assemble;
#[cfg(feature = "mcap")]
mod cdr;
mod clock;
mod column;
mod csv;
mod draft;
mod euroc;
mod file;
mod format;
mod head;
mod imu_tk;
mod imucal;
#[cfg(feature = "mcap")]
mod mcap;
#[cfg(feature = "mcap")]
mod mcap_end;
mod mcap_records;
mod movella_dot;
mod mt_manager;
mod naming;
mod options;
mod packets;
mod pair;
#[cfg(feature = "parquet")]
mod parquet;
mod parquet_pages;
mod read;
mod readings;
mod samples;
mod source;
mod unit;
mod unnamed;
mod xsens;
#[cfg(feature = "mcap")]
pub use accelerometer::read_accelerometer;
pub use column::{ColumnMeaning, ImuColumn};
pub use file::{ImuFile, SecondFile};
pub use format::FileFormat;
pub use options::{ColumnMapping, ImuReadOptions};
pub use pair::{parse_imu_pair, read_imu_pair};
pub use read::{parse_imu_recording, read_imu_recording, read_imu_sensor};
pub use unit::{ColumnUnit, ImuUnit, TimeUnit};
