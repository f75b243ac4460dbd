//! A log of a motion as a file holds it.

use super::format::ReferenceFormat;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_machine::log::{JointLog, PoseLog, ReferenceLog};
use calibrant_machine::spline::VectorSpline;

/// A log of a machine's motion as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceLogFile {
    /// The samples: times in s that do not decrease, positions in rad and m.
    pub log: ReferenceLog,
    /// Is the unit of each joint's column that of an angle? `None` where nothing says it.
    pub turns: Vec<Option<bool>>,
    /// The format, as recognised.
    pub format: ReferenceFormat,
    /// What was noticed.
    pub findings: Vec<Diagnostic>,
    /// Number of rows or messages, dropped ones included.
    pub rows: usize,
    /// SHA-256 of the bytes of the file, hexadecimal.
    pub sha256: String,
    /// The time from which the times count, ns, where they count from their first and the file has another.
    pub counted_from_ns: Option<i128>,
    /// Distance of the knots of its cubic splines, s, where the file states it: a trajectory does, and the log of a simulation of one.
    pub knot_step_s: Option<f64>,
    /// The trajectory through the knots, where the rows are those of one. The log has its positions at and between the knots then.
    pub trajectory: Option<VectorSpline>,
}

impl ReferenceLogFile {
    /// The positions of joints, where it has them.
    #[must_use]
    pub fn joints(&self) -> Option<&JointLog> {
        match &self.log {
            ReferenceLog::Joints(log) => Some(log),
            ReferenceLog::Poses(_) => None,
        }
    }

    /// The poses, where it has them.
    #[must_use]
    pub fn poses(&self) -> Option<&PoseLog> {
        match &self.log {
            ReferenceLog::Poses(log) => Some(log),
            ReferenceLog::Joints(_) => None,
        }
    }

    /// Moves the times to the clock of a recording, where one of the two files or both count time from their
    /// first sample: time stamps in both files are then those of one clock again. `recording_counted_from_ns` is
    /// [`ImuFile::counted_from_ns`](crate::ImuFile::counted_from_ns).
    pub fn put_on_clock_of(&mut self, recording_counted_from_ns: Option<i128>) {
        let later_s = match (self.counted_from_ns, recording_counted_from_ns) {
            (Some(own), Some(other)) => own.saturating_sub(other) as f64 / 1e9,
            (None, Some(other)) if self.log.times_s().first().is_some_and(|t| is_epoch(*t)) => {
                -(other as f64 / 1e9)
            }
            _ => return,
        };
        let times_s = match &mut self.log {
            ReferenceLog::Joints(log) => &mut log.times_s,
            ReferenceLog::Poses(log) => &mut log.times_s,
        };
        times_s.iter_mut().for_each(|t| *t += later_s);
        self.counted_from_ns = recording_counted_from_ns;
    }
}

/// Does a time, s, count from an epoch of a calendar?
fn is_epoch(time_s: f64) -> bool {
    time_s > crate::recording::clock_column::EPOCH_S
}
