//! A log of either kind: the joints' positions, or the poses of a body.

use nalgebra::{UnitQuaternion, Vector3};

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

/// A log of joint positions.
#[derive(Debug, Clone, PartialEq)]
pub struct JointLog {
    /// Names of the joints, one for each column.
    pub names: Vec<String>,
    /// Times, s: finite, not decreasing. Repeated samples are allowed.
    pub times_s: Vec<f64>,
    /// Positions, rad or m, row by row: one row for each time. A value that was not recorded is NaN.
    pub positions: Vec<f64>,
    /// Velocities in the same order, rad/s or m/s, where the machine logs them.
    pub velocities: Option<Vec<f64>>,
}

impl JointLog {
    /// The positions at sample `k`.
    #[must_use]
    pub fn row(&self, k: usize) -> &[f64] {
        &self.positions[k * self.names.len()..][..self.names.len()]
    }
}

/// A log of poses in a frame that does not move.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseLog {
    /// Times, s: finite, not decreasing. Repeated samples are allowed.
    pub times_s: Vec<f64>,
    /// Position of the body in the world, m; `None` where it was not seen.
    pub positions_m: Vec<Option<Vector3<f64>>>,
    /// Orientation of the body in the world; `None` where it was not seen.
    pub world_from_body: Vec<Option<UnitQuaternion<f64>>>,
}
