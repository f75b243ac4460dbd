//! The gravity of `[motion]`: the specific force of the sensor at rest, and how well it is known.
//!
//! Three numbers give it in the sensor's axes; for a sensor of one axis one number may stand for them. A
//! direction (`gravity = "z"`) takes its magnitude as `[holds]` does, from a value or from latitude and height.

use super::gravity::gravity_of;
use super::motion::MotionSection;
use super::number::{Either, PerAxis, Range};
use super::ranges::{GravityComponent, GravityMps2, LARGEST_GRAVITY, LEAST_GRAVITY};
use super::refused_key::{narrowed, refused};
use super::remedies::MOTION_GRAVITY;
use calibrant_core::error::Result;
use calibrant_core::motion::MotionGravity;
use calibrant_core::sensor::Sensor;
use nalgebra::Vector3;

impl MotionSection {
    /// Gravity, where `[motion]` gives it.
    pub(super) fn gravity_of(&self, sensor: &Sensor) -> Result<Option<MotionGravity>> {
        let given = [
            ("motion.latitude_deg", self.latitude_deg.is_some()),
            ("motion.height_m", self.height_m.is_some()),
            ("motion.gravity_sd_mps2", self.gravity_sd_mps2.is_some()),
            ("motion.tilt_sd_deg", self.tilt_sd_deg.is_some()),
        ];
        let place = &given[..2];
        let (force_mps2, sd_mps2) = match (&self.gravity, &self.gravity_mps2) {
            (Some(_), Some(Either::Compound(_))) => {
                let help = "gravity_mps2 = 9.80665, or leave `gravity` out";
                return Err(refused("motion.gravity_mps2", "the direction of gravity is given twice", help));
            }
            (Some(up), value) => {
                let magnitude = match value {
                    Some(Either::Single(value)) => {
                        Some(narrowed("motion.gravity_mps2", *value, &GravityMps2::BOUNDS)?)
                    }
                    _ => None,
                };
                let (value, place) = ((magnitude, self.gravity_sd_mps2), (self.latitude_deg, self.height_m));
                let gravity = gravity_of("motion", value, place, false)?;
                (up.unit() * gravity.magnitude_mps2, gravity.sd_mps2)
            }
            (None, Some(value)) => {
                if let Some((key, _)) = place.iter().find(|(_, is_there)| *is_there) {
                    let help = "leave it out, or give gravity = \"z\" with latitude_deg and height_m";
                    return Err(refused(*key, "gravity is given twice", help));
                }
                (force(value, sensor.axes)?, self.gravity_sd_mps2.map_or(0.0, f64::from))
            }
            (None, None) => {
                return match given.iter().find(|(_, is_there)| *is_there) {
                    Some((key, _)) => {
                        Err(refused(*key, "no gravity is given to which this belongs", MOTION_GRAVITY))
                    }
                    None => Ok(None),
                };
            }
        };
        let tilt_sd_deg = self.tilt_sd_deg.map_or(MotionGravity::USUAL_TILT_SD_DEG, f64::from);
        let gravity = MotionGravity { force_mps2, sd_mps2, tilt_sd_rad: tilt_sd_deg.to_radians() };
        check_range(self, sensor, &gravity)?;
        Ok(Some(gravity))
    }
}

fn force(value: &PerAxis<GravityComponent>, axes: usize) -> Result<Vector3<f64>> {
    /// The key.
    const KEY: &str = "motion.gravity_mps2";
    let force = match value {
        Either::Compound(numbers) => {
            let [x, y, z] = numbers.as_slice() else {
                let message = format!("a force has three numbers, this has {}", numbers.len());
                return Err(refused(KEY, message, MOTION_GRAVITY));
            };
            Vector3::new(x.get(), y.get(), z.get())
        }
        Either::Single(value) if axes == 1 => Vector3::new(value.get(), 0.0, 0.0),
        Either::Single(_) => {
            let help = format!("{MOTION_GRAVITY}; or gravity = \"z\" beside it");
            return Err(refused(KEY, "nothing says which axis is up", help));
        }
    };
    if (LEAST_GRAVITY..=LARGEST_GRAVITY).contains(&force.norm()) {
        return Ok(force);
    }
    let message = format!("a force of {} m/s² is out of range", force.norm());
    Err(refused(KEY, message, format!("a magnitude from {LEAST_GRAVITY} to {LARGEST_GRAVITY} m/s²")))
}

/// A sensor whose range gravity exceeds reads nothing of the motion.
fn check_range(section: &MotionSection, sensor: &Sensor, gravity: &MotionGravity) -> Result<()> {
    let Some(range) = sensor.range_mps2 else { return Ok(()) };
    let left = gravity.range_left(&range);
    let Some(axis) = sensor.active_axes().iter().find(|axis| left[axis.index()] <= 0.0) else {
        return Ok(());
    };
    let message = format!(
        "gravity alone, {:.2} m/s² on axis {axis}, exceeds sensor.range_mps2 = {}",
        gravity.force_mps2[axis.index()],
        range[axis.index()]
    );
    let key = if section.gravity.is_some() { "motion.gravity" } else { "motion.gravity_mps2" };
    Err(refused(key, message, "raise sensor.range_mps2, or mount the sensor otherwise"))
}
