//! Logs of a machine's motion: the positions of its joints, or the pose of the body that carries the sensor.
//!
//! | format | recognised by | times | content |
//! |---|---|---|---|
//! | joints | columns `NAME_rad`, `_deg`, `_m`, `_mm` | by name | positions; velocities from `NAME_radps`, `_degps`, `_mps`, … |
//! | RTDE | columns `actual_q_0`, … | s | positions in rad, velocities `actual_qd_0`, … |
//! | EuRoC | `#timestamp,p_RS_R_x [m],…,q_RS_w [],…` | ns | poses, w first |
//! | poses | columns `px_m`, …, `qw`, …, or other names of a position and a quaternion | by name | poses, in the order of the names |
//! | TUM | eight columns without a header, `t x y z qx qy qz qw` | s | poses, w last |
//! | Motive | its first line, `Format Version,…` | s | poses of OptiTrack's rigid bodies |
//! | Vicon | its first line, `Objects` or `Segments` | frames | poses of Tracker's objects or of Nexus' segments |
//! | Qualisys | its first line, and `DATA_INCLUDED 6D` | s | poses of rigid bodies |
//! | bag of ROS: MCAP, `.db3`, `.bag` | its first bytes | `header.stamp` | `JointState`, `PoseStamped`, `TransformStamped`, `Odometry`, `TFMessage` |
//!
//! The rows are read as those of recordings are. [`text_columns`] finds what the columns hold, [`rows`] reads
//! them, and [`log_assembly`] makes a log of their values. A value that is NaN was not recorded: the body was not
//! seen. Times may stand still; one that goes backwards is an error.

mod angles;
mod blank_poses;
mod body_speed;
mod column_faults;
mod content;
mod file;
mod format;
mod held_rows;
mod in_memory;
mod joint_columns;
mod joint_layout;
mod joints_in_order;
mod log_assembly;
mod log_columns;
mod log_head;
#[cfg(feature = "mcap")]
mod mcap;
#[cfg(feature = "mcap")]
mod messages;
mod motive;
mod options;
mod orientation_form;
mod pose_columns;
mod pose_layout;
mod qualisys;
mod quaternion;
mod read;
mod recognise;
mod rows;
#[cfg(test)]
mod said_columns_tests;
mod text_columns;
mod time_layout;
mod tracker_export;
mod vicon;
mod writer;

pub use file::ReferenceLogFile;
pub use format::ReferenceFormat;
pub use log_columns::{AngleUnit, JointUnit, LengthUnit, LogColumns, TimeColumns};
pub use options::ReferenceLogOptions;
pub use orientation_form::OrientationForm;
pub use read::{parse_reference_log, read_reference_log};
pub use recognise::{is_reference_log, unusable_log};
pub use writer::{write_joint_log, write_pose_log};
