//! Recordings, logs of machines and motions, in and out: text, Parquet and bags.
//!
//! | file | in | out |
//! |---|---|---|
//! | `recording.csv` and other recordings, in many formats | [`read_imu_recording`], [`read_imu_pair`] | [`write_recording`] |
//! | corrected recordings | | [`write_corrected_recording`] |
//! | `joints.csv`, poses of a tracker, bags | [`read_reference_log`] | [`write_joint_log`], [`write_pose_log`] |
//! | `trajectory.csv` | [`read_trajectory`], [`read_reference_log`] | [`write_trajectory`] |
//! | `follow_joint_trajectory.yaml`, `trajectory.script` | | [`write_goal`], [`write_urscript`] |
//! | `motion.csv`, `motion_dense.csv` | [`read_motion`] | [`write_motion`], [`write_dense_motion`] |
//! | `poses.csv` | [`read_poses`] | [`write_poses`] |
//! | tables of results (CSV, Parquet) | | [`Table`] |
//! | data set of a fleet (Parquet) | `ParquetRows` | |
//!
//! These are the files whose rows are many, so they are compiled for speed. `calibrant-io` has the others: experiments, machines, conventions, results.

#[doc(hidden)]
pub mod files;
mod motion;
mod recording;
mod reference_log;
mod table;
#[doc(hidden)]
pub mod text;
mod trajectory;

pub use files::atomic_output::{remove_unfinished, write_atomically, write_text};
pub use files::file_name::file_name;
pub use files::hashed_file::HashedFile;
pub use files::program::program;
pub use files::utc_time::UtcTime;
pub use motion::commanded::{parse_motion, read_motion, write_motion};
pub use motion::dense::write_dense_motion;
pub use motion::poses::{read_poses, write_poses};
pub use recording::corrected::{check_not_corrected, write_corrected_recording};
pub use recording::ferraris_sections::{Section, SectionKind, parse_sections, read_sections};
pub use recording::named_sensor::sensor_named_in;
pub use recording::stated_rate;
pub use recording::{
    AccelerometerOnly, ColumnMapping, ColumnMeaning, ColumnUnit, FileFormat, ImuColumn, ImuFile,
    ImuReadOptions, ImuUnit, SampleTimes, SecondFile, Sensitivity, TYPED_RATE_SD_PPM, TimeUnit,
    USUAL_RATE_SD_PPM, check_counts, imu_from_columns, imu_pair_of, parse_imu_pair, parse_imu_recording,
    read_imu_pair, read_imu_recording, read_imu_sensor, write_imu_recording, write_recording,
};
pub use reference_log::{
    AngleUnit, JointUnit, LengthUnit, LogColumns, OrientationForm, ReferenceFormat, ReferenceLogFile,
    ReferenceLogOptions, TimeColumns, is_reference_log, parse_reference_log, read_reference_log,
    unusable_log, write_joint_log, write_pose_log,
};
#[cfg(feature = "parquet")]
pub use table::ParquetRows;
pub use table::spreadsheet_text;
pub use table::{ColumnValues, Table, TableColumn, TableFormat};
pub use text::decoding::{Checked, install_with, open_file, read_text};
pub use text::similar_word::nearest;
pub use trajectory::{
    MOST_POINTS, Trajectory, goal_text, read_trajectory, urscript_text, write_goal, write_trajectory,
    write_urscript,
};
