//! `[machine]`: the machine that carries the sensor, and what is known of both.

use super::ImuPlan;
use super::direction::{Direction, unit_vector};
use super::gravity::GravityKeys;
use super::machine_mount::MountSection;
use super::machine_simulation::MachineSimulation;
use super::machine_source::{MachineSource, UrdfSource};
use super::number::{Either, Within, set};
use super::ranges::{
    BaseTilt, Delay, DelaySd, GravityMps2, GravitySd, Height, JointRotationSd, JointTranslationSd,
    JointZeroSd, KnotStep, Latitude, RateSd, SampleOfLog,
};
use super::refused_key::{missing, refused};
use calibrant_core::error::Result;
use calibrant_core::sensor::{Sensor, SensorModel};
use calibrant_machine::estimate::{MachineSetup, MachineTrust, MountingPrior};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// `[machine]`: the machine that carries the sensor, and what is known of both.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineSection {
    /// Path of the machine's URDF file, or the name of one that is built in. Without it the log has poses.
    pub urdf: Option<String>,
    /// Link that does not move.
    pub base: Option<String>,
    /// Link that carries the sensor.
    pub tip: Option<String>,
    /// Directories in which the packages of its meshes lie.
    pub packages: Option<Vec<PathBuf>>,
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
    pub sensor_noise: Option<NoiseFrom>,
    /// Where the sensor is on the tip.
    pub mount: Option<MountSection>,
    /// The clocks.
    pub clock: Option<ClockSection>,
    /// How well the URDF file describes the machine.
    pub geometry: Option<GeometrySection>,
    /// The log of the motion.
    pub log: Option<LogSection>,
    /// What only a simulation needs.
    pub simulate: Option<MachineSimulation>,
}

/// Where the noise of sensors is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NoiseFrom {
    /// The residuals.
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
    /// Topic in a bag with several.
    pub topic: Option<String>,
}

/// A sensor on a machine, as `[machine]` describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct MachinePlan {
    /// The machine; `None` where the reference is a log of poses.
    pub source: Option<MachineSource>,
    /// The source of the value of gravity, in words: `given`, or `from latitude 52.2°, height 30 m`.
    pub gravity_source: String,
    /// Is the sensors' noise that of their datasheets? Otherwise it follows from the residuals.
    pub noise_of_datasheet: bool,
    /// Noise of one sample of the log, where it is given.
    pub log_noise: Option<LogNoise>,
    /// Topic of the log in a bag that has several.
    pub log_topic: Option<String>,
    /// The settings that only `simulate` needs.
    pub simulation: MachineSimulation,
    /// What is known, but for the noise.
    known: MachineSetup,
}

/// Noise of one sample of a log.
#[derive(Debug, Clone, PartialEq)]
pub enum LogNoise {
    /// The same for each joint, rad or m.
    OfEachJoint(f64),
    /// Joint by joint, rad or m.
    OfJoints(Vec<f64>),
    /// Of a pose.
    OfPoses {
        /// Of the position along each axis, m.
        position_m: f64,
        /// Of the orientation about each axis, rad.
        orientation_rad: f64,
    },
}

impl LogNoise {
    /// The noise of each component of a log: of each joint, or of three axes of position and three of orientation.
    fn of_components(&self, joints: usize) -> Vec<f64> {
        match self {
            Self::OfEachJoint(noise) => vec![*noise; joints],
            Self::OfJoints(noise) => noise.clone(),
            Self::OfPoses { position_m, orientation_rad } => {
                [[*position_m; 3], [*orientation_rad; 3]].concat()
            }
        }
    }
}

impl MachinePlan {
    /// What is known beforehand, for a machine with this number of joints.
    #[must_use]
    pub fn setup(&self, accelerometer: &Sensor, imu: Option<&ImuPlan>, joints: usize) -> MachineSetup {
        let mut setup = self.known.clone();
        setup.reference_noise = self.log_noise.as_ref().map(|noise| noise.of_components(joints));
        if self.noise_of_datasheet {
            let gain = accelerometer.gain.unwrap_or_else(|| Vector3::repeat(1.0));
            setup.accelerometer_noise = accelerometer.noise(&gain);
            setup.gyroscope_noise = imu.and_then(|imu| imu.gyroscope.noise);
        }
        setup
    }
}

impl MachineSection {
    /// The plan of such a machine. `directory` is that of the experiment file.
    pub(super) fn plan(&self, sensor: &Sensor, directory: Option<&Path>) -> Result<MachinePlan> {
        let source = self.source(directory)?;
        let keys = GravityKeys {
            section: "machine",
            gravity_mps2: self.gravity_mps2.map(f64::from),
            gravity_sd_mps2: self.gravity_sd_mps2,
            latitude_deg: self.latitude_deg,
            height_m: self.height_m,
        };
        let (gravity, gravity_source) = keys.magnitude(false)?;
        let mut known = MachineSetup {
            gravity_mps2: gravity.magnitude_mps2,
            gravity_sd_mps2: gravity.sd_mps2,
            ..MachineSetup::default()
        };
        known.trust = self.trust.unwrap_or(known.trust);
        if let Some(up) = &self.up {
            known.up = unit_vector("machine.up", up)?;
        }
        if let Some(tilt) = self.tilt_sd_deg {
            known.tilt_sd_rad = tilt.get().to_radians();
        }
        if let Some(mount) = &self.mount {
            mount.add_to(&mut known)?;
            if known.mounting == MountingPrior::Unknown && sensor.model != SensorModel::Full {
                let help = "model = \"full\" in [sensor], or a rotation that is known";
                let message = "an unknown mounting needs the full model";
                return Err(refused("machine.mount.rotation", message, help));
            }
        }
        if let Some(clock) = &self.clock {
            set(&mut known.delay_s, clock.delay_s);
            set(&mut known.delay_sd_s, clock.delay_sd_s);
            set(&mut known.delay_difference_sd_s, clock.delay_difference_sd_s);
            if let Some(rate) = clock.rate_sd_ppm {
                known.clock_rate_sd = rate.get() / 1e6;
            }
        }
        if let Some(geometry) = &self.geometry {
            if source.is_none() {
                let help = "take it out, or name the machine: urdf = … in [machine]";
                return Err(refused("machine.geometry", "without a urdf there are no joints", help));
            }
            set(&mut known.geometry_translation_sd_m, geometry.translation_sd_m);
            set(&mut known.geometry_rotation_sd_rad, geometry.rotation_sd_rad);
            set(&mut known.zero_sd, geometry.zero_sd);
        }
        let log = self.log.as_ref();
        known.knot_step_s = log.and_then(|log| log.knot_step_s).map(f64::from);
        let simulation = self.simulate.unwrap_or_default();
        if simulation.resolution != 0.0 && source.is_none() {
            let help = "take it out, or name the machine: urdf = … in [machine]";
            let message = "without a urdf there are no encoders";
            return Err(refused("machine.simulate.resolution", message, help));
        }
        Ok(MachinePlan {
            simulation,
            log_topic: log.and_then(|log| log.topic.clone()),
            log_noise: log.map(|log| log.noise_of(source.is_some())).transpose()?.flatten(),
            source,
            gravity_source,
            noise_of_datasheet: self.sensor_noise == Some(NoiseFrom::Datasheet),
            known,
        })
    }

    fn source(&self, directory: Option<&Path>) -> Result<Option<MachineSource>> {
        let Some(urdf) = &self.urdf else {
            let of_joints = [
                ("machine.base", self.base.is_some()),
                ("machine.tip", self.tip.is_some()),
                ("machine.packages", self.packages.is_some()),
            ];
            return match of_joints.iter().find(|(_, is_there)| *is_there) {
                Some((key, _)) => {
                    let help = "urdf = \"arm.urdf\" in [machine], for example";
                    Err(refused(*key, "this needs a machine", help))
                }
                None => Ok(None),
            };
        };
        let beside =
            |path: &PathBuf| directory.map_or_else(|| path.clone(), |directory| directory.join(path));
        Ok(Some(MachineSource {
            urdf: UrdfSource::named(urdf, directory)?,
            base: self.base.clone(),
            tip: self.tip.clone(),
            packages: self.packages.iter().flatten().map(beside).collect(),
        }))
    }

    /// Refuses the datasheets' noise where one of them does not state it.
    pub(super) fn check_noise(&self, sensor: &Sensor, imu: Option<&ImuPlan>) -> Result<()> {
        let missing = if self.sensor_noise != Some(NoiseFrom::Datasheet) {
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
    fn noise_of(&self, has_joints: bool) -> Result<Option<LogNoise>> {
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
            (Some(Either::Single(noise)), _, _) => Ok(Some(LogNoise::OfEachJoint(noise.get()))),
            (Some(Either::Compound(noise)), _, _) => {
                Ok(Some(LogNoise::OfJoints(noise.iter().map(|noise| noise.get()).collect())))
            }
            (None, None, None) => Ok(None),
            (None, Some(position), Some(orientation)) => {
                Ok(Some(LogNoise::OfPoses { position_m: position.get(), orientation_rad: orientation.get() }))
            }
            (None, Some(_), None) => Err(missing(key("orientation_noise_rad"), "give both, or neither")),
            (None, None, Some(_)) => Err(missing(key("position_noise_m"), "give both, or neither")),
        }
    }
}
