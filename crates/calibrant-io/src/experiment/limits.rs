//! Reads `[limits]`: the limits of the arm.

use super::known_keys;
use super::number_range::Bounds;
use super::toml_document::Section;
use calibrant_core::error::Result;
use calibrant_core::motion::{Limits, Rest};
use nalgebra::Vector3;

/// Range of an acceleration limit.
const ACCELERATION: Bounds = Bounds::above(0.0, 1e9, "m/s²");
/// Range of a jerk limit.
const JERK: Bounds = Bounds::above(0.0, 1e9, "m/s³");
/// Range of a velocity limit.
const VELOCITY: Bounds = Bounds::above(0.0, 1e9, "m/s");
/// Range of a prescribed acceleration: of either sign, or zero.
const END: Bounds = Bounds::from(-1e9, 1e9, "m/s²");
/// Range of a displacement limit.
const DISPLACEMENT: Bounds = Bounds::above(0.0, 1e9, "m");

/// Reads the limits of an experiment that varies another. They take the place of all limits of the other;
/// `None` where the section has none.
pub(super) fn read_instead(section: &Section<'_>, axes: usize) -> Result<Option<Limits>> {
    let any = section.entries().any(|(key, _)| known_keys::allowed("limits").contains(&key));
    any.then(|| read(section, axes)).transpose()
}

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
        start_acceleration_mps2: limit("start_acceleration_mps2", &END)?,
        end_acceleration_mps2: limit("end_acceleration_mps2", &END)?,
    })
}
