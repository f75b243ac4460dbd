//! Draws the gravity that a tilted sensor senses.

use super::Rng;
use crate::form::As;
use crate::motion::MotionGravity;
use nalgebra::{Rotation3, Vector3};
use rand_distr::{Distribution, StandardNormal};
use schemars::JsonSchema;
use serde::Serialize;

/// Gravity as it is, where it was only given with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct TrueGravity {
    /// Specific force of the sensor at rest, m/s².
    #[serde(with = "As::<[f64; 3]>")]
    pub force_mps2: Vector3<f64>,
    /// Tilt about each axis, rad.
    #[serde(with = "As::<[f64; 3]>")]
    pub tilt_rad: Vector3<f64>,
}

/// Draws a tilt and a magnitude, and turns gravity by the tilt: exactly, not to first order.
#[must_use]
pub fn draw_gravity(gravity: &MotionGravity, rng: &mut Rng) -> TrueGravity {
    let mut normal = || -> f64 { StandardNormal.sample(rng) };
    let up = gravity.force_mps2.normalize();
    let any = Vector3::new(normal(), normal(), normal());
    let tilt_rad = (any - up * up.dot(&any)) * gravity.tilt_sd_rad;
    let force = gravity.force_mps2 + up * (gravity.sd_mps2 * normal());
    TrueGravity { force_mps2: Rotation3::new(tilt_rad) * force, tilt_rad }
}
