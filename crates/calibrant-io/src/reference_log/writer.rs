//! Writes `joints.csv` and `poses.csv`.

use crate::files::atomic_output::write_atomically;
use calibrant_core::error::Result;
use calibrant_machine::log::{JointLog, PoseLog};
use std::path::Path;

/// Writes a log of joints as CSV with the header `t_s,NAME_rad,…` (or `_m`), with this unit for each joint.
///
/// Numbers are written with the fewest digits that read back to the same bits. A position that was not recorded is `nan`.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
///
/// # Examples
/// ```
/// use calibrant_io::{ReferenceLogOptions, read_reference_log, write_joint_log};
/// use calibrant_machine::log::JointLog;
/// let (names, times_s) = (vec!["elbow".to_owned(), "rail".to_owned()], vec![0.0, 0.1]);
/// let log = JointLog { names, times_s, positions: vec![0.1, 0.2, 0.3, f64::NAN], velocities: None };
/// let directory = tempfile::tempdir().expect("a temporary directory");
/// let path = directory.path().join("joints.csv");
/// write_joint_log(&path, &log, &["rad", "m"])?;
/// let read = read_reference_log(&path, &ReferenceLogOptions::default())?;
/// assert_eq!(read.joints().expect("of joints").positions[..3], log.positions[..3]);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn write_joint_log(path: &Path, log: &JointLog, units: &[&str]) -> Result<()> {
    write_atomically(path, |out| {
        write!(out, "t_s")?;
        log.names.iter().zip(units).try_for_each(|(name, unit)| write!(out, ",{name}_{unit}"))?;
        writeln!(out)?;
        for (k, time_s) in log.times_s.iter().enumerate() {
            write!(out, "{time_s:?}")?;
            log.row(k).iter().try_for_each(|position| write!(out, ",{}", digits(*position)))?;
            writeln!(out)?;
        }
        Ok(())
    })
}

/// Writes a log of poses as CSV with the header `t_s,px_m,py_m,pz_m,qw,qx,qy,qz`. What was not seen is `nan`.
///
/// # Errors
/// As [`write_joint_log`].
pub fn write_pose_log(path: &Path, log: &PoseLog) -> Result<()> {
    write_atomically(path, |out| {
        writeln!(out, "t_s,px_m,py_m,pz_m,qw,qx,qy,qz")?;
        for (k, time_s) in log.times_s.iter().enumerate() {
            let position = log.positions_m[k].map_or([f64::NAN; 3], |p| [p.x, p.y, p.z]);
            let orientation = log.world_from_body[k].map_or([f64::NAN; 4], |q| [q.w, q.i, q.j, q.k]);
            write!(out, "{time_s:?}")?;
            position.iter().chain(&orientation).try_for_each(|value| write!(out, ",{}", digits(*value)))?;
            writeln!(out)?;
        }
        Ok(())
    })
}

/// The shortest digits of a number.
fn digits(value: f64) -> String {
    if value.is_nan() { "nan".into() } else { format!("{value:?}") }
}
