//! Distances that the machine keeps: of its bodies from each other and from what stands around.

use nalgebra::{Isometry3, Vector3};

/// The distance of two bodies at one posture, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proximity {
    /// The distance, m; negative where they overlap.
    pub distance_m: f64,
    /// Frame of one body (0 is the base, `k` the frame behind joint `k`), and its nearest point, in the axes of the base, m.
    pub a: (usize, Vector3<f64>),
    /// The same of the other.
    pub b: (usize, Vector3<f64>),
    /// Direction from `a` to `b`, a unit vector.
    pub normal: Vector3<f64>,
}

/// Two bodies whose distance is a row.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyPair {
    /// Names of the bodies.
    pub names: [String; 2],
    /// Their frames.
    pub frames: [usize; 2],
    /// Largest distance of a point of each body from the origin of its frame, m.
    pub extents_m: [f64; 2],
}

/// What a machine may collide with, itself included.
pub trait Surroundings: Sync {
    /// Number of distances.
    fn rows(&self) -> usize;

    /// The bodies of a distance.
    fn pair(&self, row: usize) -> BodyPair;

    /// All distances. `frames` are the poses of the base and of the frames behind each joint, in the base; m.
    fn proximities(&self, frames: &[Isometry3<f64>], out: &mut [Proximity]);
}

impl Proximity {
    /// Bodies far from each other.
    pub(crate) fn far() -> Self {
        let nowhere = (0, Vector3::zeros());
        Self { distance_m: f64::INFINITY, a: nowhere, b: nowhere, normal: Vector3::z() }
    }
}
