//! `[machine]`: the machine that carries the sensor, and what is known of both.

use super::ImuPlan;
use super::direction::Direction;
use super::gravity::gravity_of;
use super::machine_design::MachineDesignSection;
use super::machine_limits::MachineLimitsSection;
use super::machine_mount::MountSection;
use super::machine_simulation::MachineSimulation;
use super::machine_source::UrdfSource;
use super::machine_world::{MachineWorld, WorldSection};
use super::number::{Either, Within, set};
use super::ranges::{
    BaseTilt, Delay, DelaySd, GravityMps2, GravitySd, Height, JointRotationSd, JointTranslationSd,
    JointZeroSd, KnotStep, Latitude, RateSd, SampleOfLog,
};
use super::refused_key::{missing, refused};
use crate::machine::MachineBodies;
use calibrant_core::error::Result;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::{Sensor, SensorModel};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::estimate::{MachineSetup, MachineTrust, MountingPrior};
use calibrant_recording::{LogColumns, ReferenceLogOptions};
use nalgebra::{Unit, Vector3};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// `[machine]`: the machine that carries the sensor, and what is known of both.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MachinePlan {
    /// The machine: a URDF file, or one that is built in. Without it the reference is a log of poses.
    pub urdf: Option<UrdfSource>,
    /// A machine that is built in code, in the place of `urdf`. A file cannot have it.
    #[serde(skip)]
    pub chain: Option<Box<KinematicChain>>,
    /// Link that does not move; by default the first.
    pub base: Option<String>,
    /// Link that carries the sensor; by default the last, if there is one.
    pub tip: Option<String>,
    /// Directories in which the packages of its meshes lie.
    pub packages: Vec<PathBuf>,
    /// How far the log is trusted.
    pub trust: Option<MachineTrust>,
    /// Direction up in the base.
    pub up: Option<Direction>,
    /// Magnitude of gravity. Latitude and height may stand in its place.
    pub gravity_mps2: Option<Within<GravityMps2>>,
    /// Its standard uncertainty.
    pub gravity_sd_mps2: Option<Within<GravitySd>>,
    /// Geographic latitude.
    pub latitude_deg: Option<Within<Latitude>>,
    /// Height above the sea.
    pub height_m: Option<Within<Height>>,
    /// Standard deviation of the base's tilt about each of two axes.
    pub tilt_sd_deg: Option<Within<BaseTilt>>,
    /// Where the noise of the sensors is from.
    pub sensor_noise: NoiseFrom,
    /// Where the sensor is on the tip.
    pub mount: MountSection,
    /// The clocks.
    pub clock: ClockSection,
    /// How well the URDF file describes the machine.
    pub geometry: Option<GeometrySection>,
    /// The log of the motion.
    pub log: LogSection,
    /// What only a simulation needs.
    #[serde(rename = "simulate")]
    pub simulation: MachineSimulation,
    /// What joints and tip may do in a design.
    pub limits: Option<MachineLimitsSection>,
    /// What the machine must not touch.
    pub world: Option<WorldSection>,
    /// The trajectory that is designed.
    pub design: Option<MachineDesignSection>,
}

/// Where the noise of sensors is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NoiseFrom {
    /// The residuals.
    #[default]
    Residuals,
    /// The datasheet.
    Datasheet,
}

/// `[machine.clock]`: motion time = IMU time + delay.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClockSection {
    /// Expected delay.
    pub delay_s: Option<Within<Delay>>,
    /// Standard deviation of the delay that both sensors share.
    pub delay_sd_s: Option<Within<DelaySd>>,
    /// Standard deviation of the difference between both sensors.
    pub delay_difference_sd_s: Option<Within<DelaySd>>,
    /// Standard deviation of the rate between the two clocks.
    pub rate_sd_ppm: Option<Within<RateSd>>,
}

/// `[machine.geometry]`: how well the URDF file describes this machine.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeometrySection {
    /// Standard deviation of each joint's translations.
    pub translation_sd_m: Option<Within<JointTranslationSd>>,
    /// Standard deviation of its rotations.
    pub rotation_sd_rad: Option<Within<JointRotationSd>>,
    /// Standard deviation of the zero of each joint.
    pub zero_sd: Option<Within<JointZeroSd>>,
}

/// `[machine.log]`: the log of joints or poses.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogSection {
    /// Noise of one sample of the joints; one number for all, or one for each.
    pub noise: Option<Either<Within<SampleOfLog>, Vec<Within<SampleOfLog>>>>,
    /// Noise of a position along each axis.
    pub position_noise_m: Option<Within<SampleOfLog>>,
    /// Noise of an orientation about each axis.
    pub orientation_noise_rad: Option<Within<SampleOfLog>>,
    /// Distance of the waypoints that cubic splines joined.
    pub knot_step_s: Option<Within<KnotStep>>,
    /// Topic in a bag with several, or body in an export with several.
    pub topic: Option<String>,
    /// What its columns hold, where their names do not say it.
    pub columns: Option<LogColumns>,
}

impl MachinePlan {
    /// How its logs are read.
    #[must_use]
    pub fn log_options(&self) -> ReferenceLogOptions {
        ReferenceLogOptions {
            topic: self.log.topic.clone(),
            columns: self.log.columns.clone().unwrap_or_default(),
            poses: !self.has_joints(),
            ..ReferenceLogOptions::default()
        }
    }

    /// The joints that carry the sensor; `None` where the reference is a log of poses.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) as [`Urdf::read`](crate::Urdf::read) and [`Urdf::chain`](crate::Urdf::chain).
    pub fn kinematic_chain(&self) -> Result<Option<KinematicChain>> {
        match (&self.chain, &self.urdf) {
            (Some(chain), _) => Ok(Some((**chain).clone())),
            (None, Some(urdf)) => urdf.read()?.chain(self.base.as_deref(), self.tip.as_deref()).map(Some),
            (None, None) => Ok(None),
        }
    }

    /// The files that it names: of the machine, of pairs of links, of limits of joints. Those of meshes stand in the machine's.
    #[must_use]
    pub fn files(&self) -> Vec<&Path> {
        let machine = match &self.urdf {
            Some(UrdfSource::File(path)) => Some(path),
            _ => None,
        };
        let pairs = self.world.as_ref().and_then(|of| of.srdf.as_ref());
        let limits = self.limits.as_ref().and_then(|of| of.joint_limits.as_ref());
        [machine, pairs, limits].into_iter().flatten().map(PathBuf::as_path).collect()
    }

    /// What the machine must not touch, with the shapes of its links.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) as [`Urdf::bodies`](crate::Urdf::bodies) and [`WorldSection::of`].
    pub fn world(&self, chain: &KinematicChain) -> Result<MachineWorld> {
        let found = match (&self.chain, &self.urdf) {
            (None, Some(urdf)) => {
                urdf.read()?.bodies(self.base.as_deref(), self.tip.as_deref(), &self.packages)?
            }
            _ => MachineBodies::of_joints(chain),
        };
        let up = self.up.as_ref().map_or(MachineSetup::default().up, Direction::unit);
        self.world.clone().unwrap_or_default().of(chain, found, Unit::new_normalize(up))
    }

    /// Has the machine joints? Otherwise the reference is a log of poses.
    #[must_use]
    pub fn has_joints(&self) -> bool {
        self.chain.is_some() || self.urdf.is_some()
    }

    /// What is known beforehand, for a machine with this number of joints.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where keys contradict each other.
    pub fn setup(
        &self,
        accelerometer: &Sensor,
        imu: Option<&ImuPlan>,
        joints: usize,
    ) -> Result<MachineSetup> {
        let Gravity { magnitude_mps2: gravity_mps2, sd_mps2: gravity_sd_mps2 } = self.gravity()?;
        let usual = MachineSetup::default();
        let mut known = MachineSetup {
            gravity_mps2,
            gravity_sd_mps2,
            trust: self.trust.unwrap_or(usual.trust),
            up: self.up.as_ref().map_or(usual.up, Direction::unit),
            tilt_sd_rad: self.tilt_sd_deg.map_or(usual.tilt_sd_rad, |tilt| tilt.get().to_radians()),
            knot_step_s: self.log.knot_step_s.map(f64::from),
            reference_noise: self.log.noise_of(self.has_joints(), joints)?,
            known: imu.map_or_else(Vec::new, |imu| imu.known.clone()),
            ..usual
        };
        self.mount.add_to(&mut known)?;
        set(&mut known.delay_s, self.clock.delay_s);
        set(&mut known.delay_sd_s, self.clock.delay_sd_s);
        set(&mut known.delay_difference_sd_s, self.clock.delay_difference_sd_s);
        if let Some(rate) = self.clock.rate_sd_ppm {
            known.clock_rate_sd = rate.get() / 1e6;
        }
        if let Some(geometry) = &self.geometry {
            set(&mut known.geometry_translation_sd_m, geometry.translation_sd_m);
            set(&mut known.geometry_rotation_sd_rad, geometry.rotation_sd_rad);
            set(&mut known.zero_sd, geometry.zero_sd);
        }
        if self.sensor_noise == NoiseFrom::Datasheet {
            let gain = accelerometer.gain.unwrap_or_else(|| Vector3::repeat(1.0));
            known.accelerometer_noise = accelerometer.noise(&gain);
            known.gyroscope_noise = imu.and_then(|imu| imu.gyroscope.noise);
        }
        Ok(known)
    }

    fn gravity(&self) -> Result<Gravity> {
        let value = (self.gravity_mps2.map(f64::from), self.gravity_sd_mps2);
        gravity_of("machine", value, (self.latitude_deg, self.height_m), false)
    }

    /// The same machine, its paths in the directory of the experiment file.
    pub(super) fn beside(mut self, directory: Option<&Path>) -> Self {
        if let Some(directory) = directory {
            let files = [
                self.limits.as_mut().and_then(|limits| limits.joint_limits.as_mut()),
                self.world.as_mut().and_then(|world| world.srdf.as_mut()),
            ];
            let paths = self.packages.iter_mut().chain(files.into_iter().flatten());
            paths.for_each(|path| *path = directory.join(&*path));
            if let Some(UrdfSource::File(path)) = &mut self.urdf {
                *path = directory.join(&*path);
            }
        }
        self
    }

    /// Refuses keys that contradict each other, or the sensor.
    pub(super) fn check(&self, sensor: &Sensor) -> Result<()> {
        let of_joints = [
            ("machine.base", self.base.is_some()),
            ("machine.tip", self.tip.is_some()),
            ("machine.packages", !self.packages.is_empty()),
        ];
        if let Some((key, _)) = of_joints.iter().find(|(_, is_there)| *is_there && self.urdf.is_none()) {
            let help = "urdf = \"arm.urdf\" in [machine], for example";
            return Err(refused(*key, "this needs a machine", help));
        }
        let setup = self.setup(sensor, None, 0)?;
        if setup.mounting == MountingPrior::Unknown && sensor.model != SensorModel::Full {
            let help = "model = \"full\" in [sensor], or a rotation that is known";
            let message = "an unknown mounting needs the full model";
            return Err(refused("machine.mount.rotation", message, help));
        }
        self.log.check_columns(self.has_joints())?;
        let help = "take it out, or name the machine: urdf = … in [machine]";
        let of_joints = [
            ("machine.geometry", self.geometry.is_some()),
            ("machine.limits", self.limits.is_some()),
            ("machine.world", self.world.is_some()),
            ("machine.design", self.design.is_some()),
        ];
        if let Some((key, _)) = of_joints.into_iter().find(|(_, is_there)| *is_there && !self.has_joints()) {
            return Err(refused(key, "without a urdf there are no joints", help));
        }
        if self.simulation.resolution != 0.0 && !self.has_joints() {
            let message = "without a urdf there are no encoders";
            return Err(refused("machine.simulate.resolution", message, help));
        }
        Ok(())
    }

    /// Refuses the datasheets' noise where one of them does not state it.
    pub(super) fn check_noise(&self, sensor: &Sensor, imu: Option<&ImuPlan>) -> Result<()> {
        let missing = if self.sensor_noise == NoiseFrom::Residuals {
            return Ok(());
        } else if sensor.noise_mps2.is_none() && sensor.noise_counts.is_none() {
            "noise_mps2 (or noise_counts) in [sensor]"
        } else if imu.is_some_and(|imu| imu.gyroscope.noise.is_none()) {
            "noise_radps (or noise_counts) in [gyroscope]"
        } else {
            return Ok(());
        };
        let message = format!("\"datasheet\" needs {missing}");
        Err(refused("machine.sensor_noise", message, "add it, or write \"residuals\""))
    }
}

impl LogSection {
    /// Refuses columns that contradict each other, or the machine.
    fn check_columns(&self, has_joints: bool) -> Result<()> {
        let Some(columns) = &self.columns else { return Ok(()) };
        if let Some((key, message, help)) = columns.complaint() {
            let dot = if key.is_empty() { "" } else { "." };
            return Err(refused(format!("machine.log.columns{dot}{key}"), message, help));
        }
        let unsuited = match has_joints {
            true => {
                [("position", columns.position.is_some()), ("orientation", columns.orientation.is_some())]
            }
            false => [("joints", columns.joints.is_some()); 2],
        };
        let Some((key, _)) = unsuited.into_iter().find(|(_, is_there)| *is_there) else { return Ok(()) };
        let (message, help) = match has_joints {
            true => ("the log of a machine has joints", "joints = { elbow_joint = \"q3\" }, for example"),
            false => ("without a urdf the log has poses", "position, orientation and orientation_is"),
        };
        Err(refused(format!("machine.log.columns.{key}"), message, help))
    }

    /// The noise of each component of a log: of each joint, or of three axes of position and three of orientation.
    fn noise_of(&self, has_joints: bool, joints: usize) -> Result<Option<Vec<f64>>> {
        let key = |key: &str| format!("machine.log.{key}");
        let (position, orientation) = (self.position_noise_m, self.orientation_noise_rad);
        if has_joints && (position.is_some() || orientation.is_some()) {
            let at = if position.is_some() { "position_noise_m" } else { "orientation_noise_rad" };
            let help = "noise = 1e-5, for example: rad or m of one sample";
            return Err(refused(key(at), "a log of joints has no poses", help));
        }
        if !has_joints && self.noise.is_some() {
            let help = "position_noise_m and orientation_noise_rad";
            return Err(refused(key("noise"), "without a urdf the log has poses", help));
        }
        match (&self.noise, position, orientation) {
            (Some(Either::Single(noise)), _, _) => Ok(Some(vec![noise.get(); joints])),
            (Some(Either::Compound(noise)), _, _) => {
                Ok(Some(noise.iter().map(|noise| noise.get()).collect()))
            }
            (None, None, None) => Ok(None),
            (None, Some(position), Some(orientation)) => {
                Ok(Some([[position.get(); 3], [orientation.get(); 3]].concat()))
            }
            (None, Some(_), None) => Err(missing(key("orientation_noise_rad"), "give both, or neither")),
            (None, None, Some(_)) => Err(missing(key("position_noise_m"), "give both, or neither")),
        }
    }
}
