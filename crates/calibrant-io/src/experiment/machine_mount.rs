//! `[machine.mount]`: where the sensor is on the tip.

use super::number::{Either, Range, Within, set};
use super::ranges::{Lever, LeverSd, MountingSd, QuaternionComponent, RotationComponent};
use super::refused_key::{narrowed, refused};
use super::remedies::remedy;
use calibrant_core::error::Result;
use calibrant_machine::estimate::{MachineSetup, MountingPrior};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// How far from 1 the norm of a quaternion may be.
const OF_NORM: f64 = 1e-3;

/// `[machine.mount]`: where the sensor is on the tip.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MountSection {
    /// From the tip to the sensor, in the axes of the tip.
    pub lever_m: Option<Vec<Within<Lever>>>,
    /// Its standard deviation along each axis.
    pub lever_sd_m: Option<Within<LeverSd>>,
    /// From the sensor's axes to the tip's: a quaternion, a rotation vector in degrees, or unknown.
    pub rotation: Option<Either<UnknownRotation, Vec<Within<RotationComponent>>>>,
    /// Its standard deviation about each axis; 0 where a fixture defines it.
    pub rotation_sd_deg: Option<Within<MountingSd>>,
}

/// A rotation of which nothing is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum UnknownRotation {
    /// It is found from the data.
    Unknown,
}

impl MountSection {
    /// Adds the lever arm and the rotation to what is known.
    pub(super) fn add_to(&self, known: &mut MachineSetup) -> Result<()> {
        if let Some(lever) = &self.lever_m {
            let [x, y, z] = lever.as_slice() else {
                let message = format!("a lever arm has three numbers, this has {}", lever.len());
                let key = "machine.mount.lever_m";
                return Err(refused(key, message, remedy(key)));
            };
            known.lever_m = Vector3::new(x.get(), y.get(), z.get());
        }
        set(&mut known.lever_sd_m, self.lever_sd_m);
        match (&self.rotation, self.rotation_sd_deg) {
            (Some(Either::Single(UnknownRotation::Unknown)), Some(_)) => {
                let help = "take it out, or give the rotation as a quaternion or a rotation vector";
                let message = "an unknown rotation has no standard deviation";
                return Err(refused("machine.mount.rotation_sd_deg", message, help));
            }
            (Some(Either::Single(UnknownRotation::Unknown)), None) => {
                known.mounting = MountingPrior::Unknown;
            }
            (rotation, sd) => {
                if let Some(Either::Compound(numbers)) = rotation {
                    known.tip_from_sensor = turned(numbers)?;
                }
                if let Some(sd) = sd {
                    known.mounting = match sd.get().to_radians() {
                        0.0 => MountingPrior::Exact,
                        sd_rad => MountingPrior::Within(sd_rad),
                    };
                }
            }
        }
        Ok(())
    }
}

/// A quaternion, or a rotation vector in degrees.
fn turned(numbers: &[Within<RotationComponent>]) -> Result<UnitQuaternion<f64>> {
    /// The key.
    const KEY: &str = "machine.mount.rotation";
    let reject = |message: String| Err(refused(KEY, message, remedy(KEY)));
    match numbers {
        [x, y, z] => {
            let degrees = Vector3::new(x.get(), y.get(), z.get());
            Ok(UnitQuaternion::from_scaled_axis(degrees.map(f64::to_radians)))
        }
        [_, _, _, _] => {
            let component =
                |k: usize| narrowed(format!("{KEY}[{k}]"), numbers[k], &QuaternionComponent::BOUNDS);
            let quaternion = Quaternion::new(component(0)?, component(1)?, component(2)?, component(3)?);
            if (quaternion.norm() - 1.0).abs() > OF_NORM {
                return reject(format!("the norm of this quaternion is {:.4}, not 1", quaternion.norm()));
            }
            Ok(UnitQuaternion::from_quaternion(quaternion))
        }
        _ => reject(format!("a rotation has three or four numbers, this has {}", numbers.len())),
    }
}
