//! `[limits]`: what the arm can do.

use super::bounds::Bounds;
use super::document::Section;
use crate::error::Result;
use crate::motion::{Limits, Rest};
use nalgebra::Vector3;

const ACCELERATION: Bounds = Bounds::above(0.0, 1e9, "m/s²");
const JERK: Bounds = Bounds::above(0.0, 1e9, "m/s³");
const VELOCITY: Bounds = Bounds::above(0.0, 1e9, "m/s");
const DISPLACEMENT: Bounds = Bounds::above(0.0, 1e9, "m");

/// Reads `[limits]`.
pub(super) fn read(section: &Section<'_>, axes: usize) -> Result<Limits> {
    let limit = |key: &str, bounds: &Bounds| -> Result<Option<Vector3<f64>>> {
        section.get(key).map(|entry| entry.per_axis(axes, bounds)).transpose()
    };
    let rest = section.get("rest").map_or(Ok(Rest::None), |entry| {
        entry.word(&[("none", Rest::None), ("start", Rest::Start), ("both", Rest::Both)])
    })?;
    Ok(Limits {
        acceleration_mps2: limit("acceleration_mps2", &ACCELERATION)?,
        jerk_mps3: limit("jerk_mps3", &JERK)?,
        intercept_mps2: limit("intercept_mps2", &ACCELERATION)?,
        velocity_mps: limit("velocity_mps", &VELOCITY)?,
        displacement_m: limit("displacement_m", &DISPLACEMENT)?,
        rest,
        start_acceleration_mps2: None,
        end_acceleration_mps2: None,
    })
}
