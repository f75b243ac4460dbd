//! Where a machine stands.

use super::{Body, Cuboid};
use nalgebra::{Unit, Vector3};

/// The bodies of a machine, and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Bodies that move, and those of the base.
    pub bodies: Vec<Body>,
    /// Pairs of links that are known not to meet, or may touch.
    pub disabled: Vec<[String; 2]>,
    /// Height of the floor along `up` from the origin of the base, m.
    pub floor_m: Option<f64>,
    /// Boxes in the base.
    pub boxes: Vec<Cuboid>,
    /// Direction up in the base.
    pub up: Unit<Vector3<f64>>,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            bodies: Vec::new(),
            disabled: Vec::new(),
            floor_m: None,
            boxes: Vec::new(),
            up: Vector3::z_axis(),
        }
    }
}
