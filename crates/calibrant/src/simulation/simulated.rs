//! What a simulation gives, and its files.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::Result;
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::sensor::{ImuRecording, Recording, SensorKind};
use calibrant_io::{
    Truth, write_imu_recording, write_joint_log, write_json, write_motion, write_pose_log, write_recording,
};
use calibrant_machine::log::ReferenceLog;
use std::path::Path;

/// A simulated recording, and the truth behind it.
#[derive(Debug, Clone)]
pub struct Simulation {
    /// The seed of its sensor.
    pub seed: u64,
    /// The recording.
    pub recording: ImuRecording,
    /// The true parameters.
    pub truth: Truth,
    /// The commanded motion, with its number of axes.
    pub motion: Option<(JerkControlledMotion, usize)>,
    /// The motion that took place, where that is another.
    pub true_motion: Option<JerkControlledMotion>,
    /// The log of a machine, with the unit of each joint.
    pub log: Option<(ReferenceLog, Vec<&'static str>)>,
    /// Distance of the knots, s, where the machine moved on cubic splines.
    pub knot_step_s: Option<f64>,
    /// What was noticed.
    pub notes: Vec<Diagnostic>,
}

impl Simulation {
    /// One of a recording without a motion or a log.
    pub(super) fn new(seed: u64, recording: impl Into<ImuRecording>, truth: Truth) -> Self {
        let recording = recording.into();
        Self {
            seed,
            recording,
            truth,
            motion: None,
            true_motion: None,
            log: None,
            knot_step_s: None,
            notes: Vec::new(),
        }
    }

    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> usize {
        let first = self.recording[SensorKind::Accelerometer]
            .as_ref()
            .or(self.recording[SensorKind::Gyroscope].as_ref());
        first.map_or(0, Recording::len)
    }

    /// Writes `recording.csv` and `truth.json` into a directory; and `motion.csv`, `true_motion.csv`, `joints.csv` or `poses.csv`, where there are these.
    ///
    /// # Errors
    /// [`Error::Output`](crate::Error::Output) where a file cannot be written.
    pub fn write(&self, directory: &Path) -> Result<()> {
        let path = |name: &str| directory.join(name);
        if let Some((motion, axes)) = &self.motion {
            write_motion(&path("motion.csv"), motion, *axes)?;
            if let Some(happened) = &self.true_motion {
                write_motion(&path("true_motion.csv"), happened, *axes)?;
            }
        }
        write_json(&path("truth.json"), &self.truth)?;
        match &self.log {
            Some((ReferenceLog::Joints(log), units)) => {
                write_joint_log(&path("joints.csv"), log, units, self.knot_step_s)?;
            }
            Some((ReferenceLog::Poses(log), _)) => write_pose_log(&path("poses.csv"), log)?,
            None => {}
        }
        match self.recording.accelerometer_alone() {
            Some(alone) => write_recording(&path("recording.csv"), alone),
            None => write_imu_recording(&path("recording.csv"), &self.recording),
        }
    }
}
