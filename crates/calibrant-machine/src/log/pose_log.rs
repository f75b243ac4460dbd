//! The pose of a body over time, as a tracker or a robot's controller recorded it.

use nalgebra::{UnitQuaternion, Vector3};

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
