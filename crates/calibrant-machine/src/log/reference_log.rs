//! A log of either kind.

use super::{JointLog, PoseLog};

/// What a machine recorded of its motion.
#[derive(Debug, Clone, PartialEq)]
pub enum ReferenceLog {
    /// Positions of joints; a kinematic chain gives the pose of the tip.
    Joints(JointLog),
    /// Poses of the body that carries the sensor.
    Poses(PoseLog),
}

impl ReferenceLog {
    /// Times of the samples, s.
    #[must_use]
    pub fn times_s(&self) -> &[f64] {
        match self {
            Self::Joints(log) => &log.times_s,
            Self::Poses(log) => &log.times_s,
        }
    }
}
