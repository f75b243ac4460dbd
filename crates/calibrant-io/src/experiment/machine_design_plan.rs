//! All that the design of a trajectory needs of an experiment.

use super::machine_design::Dwells;
use super::machine_limits::MachineLimits;
use super::machine_world::MachineWorld;
use super::number::Within;
use super::ranges::JointPosition;
use super::refused_key::{missing, refused};
use super::{Experiment, Plan};
use calibrant_core::error::Result;
use calibrant_machine::chain::KinematicChain;
use nalgebra::Vector3;

/// All that the design of a trajectory needs of an experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineDesignPlan {
    /// The chain.
    pub chain: KinematicChain,
    /// What its joints and its tip may do.
    pub limits: MachineLimits,
    /// What it must not touch.
    pub world: MachineWorld,
    /// Largest reading of the accelerometer on each axis, m/s²; infinite where it is not given.
    pub force_range_mps2: Vector3<f64>,
    /// Largest reading of the gyroscope on each axis, rad/s; infinite where it is not given.
    pub rate_range_radps: Vector3<f64>,
    /// Noise density N of the accelerometer, m/s²/√Hz: a sample's standard deviation is N √rate.
    pub force_density: f64,
    /// Noise density N of the gyroscope, rad/s/√Hz, where there is one.
    pub rate_density: Option<f64>,
    /// Noise while the machine moves over noise at rest.
    pub moving_noise: f64,
    /// Duration of the trajectory, s.
    pub duration_s: f64,
    /// Sample rate of the IMU, Hz.
    pub rate_hz: f64,
    /// Distance of the knots, s.
    pub knot_s: f64,
    /// Posture at the beginning and the end.
    pub home: Option<Vec<f64>>,
    /// How often the machine stands still.
    pub dwells: Dwells,
}

impl Experiment {
    /// All that the design of a trajectory of the machine needs.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) about the key: there are no joints, the noise of a sensor or a limit is missing, or the home posture is out of
    /// the limits. Also as [`MachinePlan::kinematic_chain`](super::MachinePlan::kinematic_chain), and for files that cannot be read.
    pub fn machine_design(&self) -> Result<MachineDesignPlan> {
        let Plan::Machine(machine) = &self.plan else {
            let help = "see `calibrant init arm`";
            return Err(refused("", "the trajectory of a machine needs [machine]", help));
        };
        let Some(chain) = machine.kinematic_chain()? else {
            let message = "a tracker only sees a motion: a machine with joints makes one";
            return Err(refused("machine", message, "urdf = \"arm.urdf\" in [machine]"));
        };
        let design = machine.design.clone().unwrap_or_default();
        let limits = machine.limits.clone().unwrap_or_default().of(&chain)?;
        let world = machine.world(&chain)?;
        let density = |sd: Vector3<f64>| sd.mean() / design.rate_hz.sqrt();
        let gain = self.sensor.gain.unwrap_or_else(|| Vector3::repeat(1.0));
        let Some(force_noise) = self.sensor.noise(&gain) else {
            let help = "a design needs the noise of one sample, from the datasheet: noise_mps2 = 0.024 in [sensor], which is N √rate; N is the density as Kalibr takes it, a datasheet's one-sided density over √2";
            return Err(missing("sensor.noise_mps2", help));
        };
        let rate_density = match self.imu.as_ref().map(|imu| &imu.gyroscope) {
            None => None,
            Some(gyroscope) => match gyroscope.noise {
                Some(noise) => {
                    let gain = gyroscope.gain.unwrap_or_else(|| Vector3::repeat(1.0));
                    Some(density(noise.component_div(&gain)))
                }
                None => {
                    let help = "a design needs the noise of one sample, from the datasheet: noise_radps = 0.0035 in [gyroscope]";
                    return Err(missing("gyroscope.noise_radps", help));
                }
            },
        };
        let unlimited = Vector3::repeat(f64::INFINITY);
        Ok(MachineDesignPlan {
            home: home(design.home.as_deref(), &chain, &limits)?,
            force_range_mps2: self.sensor.range_mps2.unwrap_or(unlimited),
            rate_range_radps: self
                .imu
                .as_ref()
                .and_then(|imu| imu.gyroscope_range_radps)
                .unwrap_or(unlimited),
            force_density: density(force_noise),
            rate_density,
            moving_noise: design.moving_noise,
            duration_s: design.duration_s,
            rate_hz: design.rate_hz,
            knot_s: design.knot_s,
            dwells: design.dwells,
            chain,
            limits,
            world,
        })
    }
}

/// The home posture, one position for each joint, within the limits.
fn home(
    given: Option<&[Within<JointPosition>]>,
    chain: &KinematicChain,
    limits: &MachineLimits,
) -> Result<Option<Vec<f64>>> {
    let Some(given) = given else { return Ok(None) };
    let key = "machine.design.home";
    if given.len() != chain.joints.len() {
        let message = format!("{} positions for {} joints", given.len(), chain.joints.len());
        let names: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
        return Err(refused(key, message, format!("one for each, in this order: {}", names.join(", "))));
    }
    for ((joint, of), limit) in chain.joints.iter().zip(given).zip(&limits.joints) {
        let position = of.get();
        if position < limit.lower || position > limit.upper {
            let unit = joint.kind.unit();
            let message = format!(
                "`{}` is at {position} {unit}, and may be from {} to {} {unit}",
                joint.name, limit.lower, limit.upper
            );
            return Err(refused(
                key,
                message,
                "write another posture, or other positions in [machine.limits]",
            ));
        }
    }
    Ok(Some(given.iter().map(|of| of.get()).collect()))
}
