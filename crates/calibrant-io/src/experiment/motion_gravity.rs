//! Reads the gravity of `[motion]`: the specific force of the sensor at rest, and how well it is known.
//!
//! Three numbers give it in the sensor's axes; for a sensor of one axis one number may stand for them. A
//! direction (`gravity = "z"`) takes its magnitude as `[holds]` does, from a value or from latitude and height.

use super::direction::direction;
use super::gravity::{GRAVITY_SD, LARGEST, LEAST, read_gravity};
use super::number_range::Bounds;
use super::toml_document::{Entry, Section};
use calibrant_core::error::Result;
use calibrant_core::motion::MotionGravity;
use calibrant_core::sensor::Sensor;
use nalgebra::Vector3;

/// Range of a component of the force.
const COMPONENT: Bounds = Bounds::from(-LARGEST, LARGEST, "m/s²");
/// Range of the standard deviation of the tilt.
const TILT: Bounds = Bounds::from(0.0, 10.0, "degrees");
/// The remedy for gravity in another form.
const HELP: &str =
    "gravity_mps2 = [0.0, 0.0, 9.80665]: what the sensor senses at rest, in its axes, positive up";

/// Reads gravity, where `[motion]` gives it.
pub(super) fn read(section: &Section<'_>, sensor: &Sensor) -> Result<Option<MotionGravity>> {
    let entry = |key: &str| section.get(key);
    let (force, sd_mps2) = match (entry("gravity"), entry("gravity_mps2")) {
        (Some(of), value) => {
            if let Some(value) = value.filter(Entry::is_array) {
                return Err(value.reject(
                    "the direction of gravity is given twice",
                    "gravity_mps2 = 9.80665, or leave `gravity` out",
                ));
            }
            let (gravity, _) = read_gravity(section, false)?;
            (direction(&of)? * gravity.magnitude_mps2, gravity.sd_mps2)
        }
        (None, Some(value)) => {
            for key in ["latitude_deg", "height_m"] {
                if let Some(other) = entry(key) {
                    return Err(other.reject(
                        "gravity is given twice",
                        "leave it out, or give gravity = \"z\" with latitude_deg and height_m",
                    ));
                }
            }
            let sd = entry("gravity_sd_mps2").map_or(Ok(0.0), |entry| entry.number(&GRAVITY_SD))?;
            (force(&value, sensor.axes)?, sd)
        }
        (None, None) => {
            for key in ["latitude_deg", "height_m", "gravity_sd_mps2", "tilt_sd_deg"] {
                if let Some(other) = entry(key) {
                    return Err(other.reject("no gravity is given to which this belongs", HELP));
                }
            }
            return Ok(None);
        }
    };
    let usual = MotionGravity::USUAL_TILT_SD_DEG;
    let tilt_sd_deg = entry("tilt_sd_deg").map_or(Ok(usual), |entry| entry.number(&TILT))?;
    let gravity = MotionGravity { force_mps2: force, sd_mps2, tilt_sd_rad: tilt_sd_deg.to_radians() };
    check_range(section, sensor, &gravity)?;
    Ok(Some(gravity))
}

fn force(entry: &Entry<'_>, axes: usize) -> Result<Vector3<f64>> {
    let force = if entry.is_array() {
        let items = entry.items(HELP)?;
        let [x, y, z] = items.as_slice() else {
            return Err(entry.reject(format!("a force has three numbers, this has {}", items.len()), HELP));
        };
        Vector3::new(x.number(&COMPONENT)?, y.number(&COMPONENT)?, z.number(&COMPONENT)?)
    } else if axes == 1 {
        Vector3::new(entry.number(&COMPONENT)?, 0.0, 0.0)
    } else {
        entry.number(&COMPONENT)?;
        let help = format!("{HELP}; or gravity = \"z\" beside it");
        return Err(entry.reject("nothing says which axis is up", help));
    };
    if (LEAST..=LARGEST).contains(&force.norm()) {
        return Ok(force);
    }
    let message = format!("a force of {} m/s² is out of range", force.norm());
    Err(entry.reject(message, format!("a magnitude from {LEAST} to {LARGEST} m/s²")))
}

/// A sensor whose range gravity exceeds reads nothing of the motion.
fn check_range(section: &Section<'_>, sensor: &Sensor, gravity: &MotionGravity) -> Result<()> {
    let Some(range) = sensor.range_mps2 else { return Ok(()) };
    let left = gravity.range_left(&range);
    match sensor.active_axes().iter().find(|axis| left[axis.index()] <= 0.0) {
        None => Ok(()),
        Some(axis) => {
            let message = format!(
                "gravity alone, {:.2} m/s² on axis {axis}, exceeds sensor.range_mps2 = {}",
                gravity.force_mps2[axis.index()],
                range[axis.index()]
            );
            let key = if section.get("gravity").is_some() { "gravity" } else { "gravity_mps2" };
            let help = "raise sensor.range_mps2, or mount the sensor otherwise";
            Err(section.get(key).map_or_else(
                || section.reject(&message, help, key),
                |entry| entry.reject(message.clone(), help),
            ))
        }
    }
}
