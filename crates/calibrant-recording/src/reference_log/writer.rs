//! Writes `joints.csv` and `poses.csv`.

use super::read::KNOT_STEP;
use crate::text::numbers::write_numbers;
use calibrant_core::error::Result;
use calibrant_machine::log::{JointLog, PoseLog};
use std::iter::once;
use std::path::Path;

/// Writes a log of joints as CSV with the header `t_s,NAME_rad,…` (or `_m`), with this unit for each joint. Where the motion consists of cubic splines between knots of a
/// known distance, a comment says so, and whoever reads the log takes them.
///
/// Numbers are written with the fewest digits that read back to the same bits. A position that was not recorded is `nan`.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
///
/// # Examples
/// ```
/// use calibrant_recording::{ReferenceLogOptions, read_reference_log, write_joint_log};
/// use calibrant_machine::log::JointLog;
/// let (names, times_s) = (vec!["elbow".to_owned(), "rail".to_owned()], vec![0.0, 0.1]);
/// let log = JointLog { names, times_s, positions: vec![0.1, 0.2, 0.3, f64::NAN], velocities: None };
/// let directory = tempfile::tempdir().expect("a temporary directory");
/// let path = directory.path().join("joints.csv");
/// write_joint_log(&path, &log, &["rad", "m"], Some(0.2))?;
/// let read = read_reference_log(&path, &ReferenceLogOptions::default())?;
/// assert_eq!(read.joints().expect("of joints").positions[..3], log.positions[..3]);
/// assert_eq!(read.knot_step_s, Some(0.2));
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn write_joint_log(path: &Path, log: &JointLog, units: &[&str], knot_step_s: Option<f64>) -> Result<()> {
    let columns: String = log.names.iter().zip(units).map(|(name, unit)| format!(",{name}_{unit}")).collect();
    let rows = log.times_s.iter().enumerate().map(|(k, t)| once(t).chain(log.row(k)).copied());
    let knots = knot_step_s.map_or(String::new(), |step_s| format!("# {KNOT_STEP}: {step_s}\n"));
    write_numbers(path, &format!("{knots}t_s{columns}"), rows)
}

/// Writes a log of poses as CSV with the header `t_s,px_m,py_m,pz_m,qw,qx,qy,qz`. What was not seen is `nan`.
///
/// # Errors
/// As [`write_joint_log`].
pub fn write_pose_log(path: &Path, log: &PoseLog) -> Result<()> {
    let rows = log.times_s.iter().enumerate().map(|(k, t)| {
        let position = log.positions_m[k].map_or([f64::NAN; 3], |p| [p.x, p.y, p.z]);
        let orientation = log.world_from_body[k].map_or([f64::NAN; 4], |q| [q.w, q.i, q.j, q.k]);
        once(*t).chain(position).chain(orientation)
    });
    write_numbers(path, "t_s,px_m,py_m,pz_m,qw,qx,qy,qz", rows)
}
