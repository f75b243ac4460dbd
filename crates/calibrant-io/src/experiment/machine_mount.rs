//! Reads `[machine.mount]`: where the sensor is on the tip.

use super::number_range::Bounds;
use super::toml_document::{Entry, Section};
use calibrant_core::error::Result;
use calibrant_machine::estimate::{MachineSetup, MountingPrior};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Range of a lever arm. A longer one is hardly in m.
const LEVER: Bounds = Bounds::from(-20.0, 20.0, "m");
/// Range of its standard deviation.
const LEVER_SD: Bounds = Bounds::from(0.0, 10.0, "m");
/// Range of a component of a rotation vector.
const ROTATION: Bounds = Bounds::from(-360.0, 360.0, "degrees");
/// Range of a component of a quaternion.
const COMPONENT: Bounds = Bounds::from(-1.0, 1.0, "");
/// Range of the standard deviation of the mounting. One that is known less well is unknown.
const ROTATION_SD: Bounds = Bounds::from(0.0, 20.0, "degrees");
/// How far from 1 the norm of a quaternion may be.
const OF_NORM: f64 = 1e-3;

/// Reads the lever arm and the rotation into what is known.
pub(super) fn read_mount(section: &Section<'_>, known: &mut MachineSetup) -> Result<()> {
    if let Some(entry) = section.get("lever_m") {
        known.lever_m = lever(&entry)?;
    }
    if let Some(entry) = section.get("lever_sd_m") {
        known.lever_sd_m = entry.number(&LEVER_SD)?;
    }
    let sd = section.get("rotation_sd_deg");
    match section.get("rotation") {
        Some(entry) if entry.text().is_some() => {
            entry.word(&[("unknown", ())])?;
            if let Some(sd) = sd {
                let help = "take it out, or give the rotation as a quaternion or a rotation vector";
                return Err(sd.reject("an unknown rotation has no standard deviation", help));
            }
            known.mounting = MountingPrior::Unknown;
            return Ok(());
        }
        Some(entry) => known.tip_from_sensor = rotation(&entry)?,
        None => {}
    }
    if let Some(entry) = sd {
        known.mounting = match entry.number(&ROTATION_SD)?.to_radians() {
            0.0 => MountingPrior::Exact,
            sd_rad => MountingPrior::Within(sd_rad),
        };
    }
    Ok(())
}

fn lever(entry: &Entry<'_>) -> Result<Vector3<f64>> {
    /// The remedy for a wrong lever arm.
    const HELP: &str = "from the tip to the sensor in the axes of the tip, m: [0.02, -0.03, 0.04]";
    match entry.items(HELP)?.as_slice() {
        [x, y, z] => Ok(Vector3::new(x.number(&LEVER)?, y.number(&LEVER)?, z.number(&LEVER)?)),
        items => Err(entry.reject(format!("a lever arm has three numbers, this has {}", items.len()), HELP)),
    }
}

/// A quaternion, or a rotation vector in degrees.
fn rotation(entry: &Entry<'_>) -> Result<UnitQuaternion<f64>> {
    /// The remedy for a wrong rotation.
    const HELP: &str =
        "a quaternion [w, x, y, z], a rotation vector in degrees [0.0, 0.0, 90.0], or \"unknown\"";
    let items = entry.items(HELP)?;
    let numbers = |bounds: &Bounds| items.iter().map(|item| item.number(bounds)).collect::<Result<Vec<_>>>();
    match items.len() {
        3 => {
            let degrees = numbers(&ROTATION)?;
            Ok(UnitQuaternion::from_scaled_axis(Vector3::from_vec(degrees).map(f64::to_radians)))
        }
        4 => {
            let of = numbers(&COMPONENT)?;
            let quaternion = Quaternion::new(of[0], of[1], of[2], of[3]);
            if (quaternion.norm() - 1.0).abs() > OF_NORM {
                let message = format!("the norm of this quaternion is {:.4}, not 1", quaternion.norm());
                return Err(entry.reject(message, HELP));
            }
            Ok(UnitQuaternion::from_quaternion(quaternion))
        }
        length => Err(entry.reject(format!("a rotation has three or four numbers, this has {length}"), HELP)),
    }
}
