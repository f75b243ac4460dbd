//! Distances that the machine keeps: of its bodies from each other and from what stands around.

use crate::world::{BodyPair, Proximity, World};
use nalgebra::IsometryMatrix3;

/// What a machine may collide with, itself included.
pub trait Surroundings: Sync {
    /// Number of distances.
    fn rows(&self) -> usize;

    /// The bodies of a distance.
    fn pair(&self, row: usize) -> BodyPair;

    /// All distances. `frames` are the poses of the base and of the frames behind each joint, in the base; m.
    fn proximities(&self, frames: &[IsometryMatrix3<f64>], out: &mut [Proximity]);
}

impl Surroundings for World {
    fn rows(&self) -> usize {
        World::rows(self)
    }

    fn pair(&self, row: usize) -> BodyPair {
        World::pair(self, row).clone()
    }

    fn proximities(&self, frames: &[IsometryMatrix3<f64>], out: &mut [Proximity]) {
        World::proximities(self, frames, out);
    }
}
