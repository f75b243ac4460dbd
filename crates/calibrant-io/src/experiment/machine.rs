//! Reads `[machine]`: the machine that carries the sensor, and what is known of both.

use super::ImuPlan;
use super::direction::direction;
use super::gravity::read_gravity;
use super::machine_mount::read_mount;
use super::machine_simulation::{MachineSimulation, read_simulation};
use super::machine_source::{MachineSource, read_source};
use super::number_range::Bounds;
use super::toml_document::{Entry, Section};
use calibrant_core::error::Result;
use calibrant_core::sensor::{Sensor, SensorModel};
use calibrant_machine::estimate::{MachineSetup, MachineTrust, MountingPrior};
use nalgebra::Vector3;

/// Range of the tilt of the base.
const TILT: Bounds = Bounds::from(0.0, 45.0, "degrees");
/// Range of a delay.
const DELAY: Bounds = Bounds::from(-1e6, 1e6, "s");
/// Range of the standard deviation of a delay.
const DELAY_SD: Bounds = Bounds::from(0.0, 10.0, "s");
/// Range of the standard deviation of a clock's rate.
const RATE_SD: Bounds = Bounds::from(0.0, 1e5, "ppm");
/// Range of the standard deviation of a joint's translation. More is no geometry that is known.
const TRANSLATION_SD: Bounds = Bounds::from(0.0, 0.1, "m");
/// Range of the standard deviation of a joint's rotation.
const ROTATION_SD: Bounds = Bounds::from(0.0, 0.1, "rad (0.1 rad is 5.7°)");
/// Range of the standard deviation of a joint's zero offset.
const ZERO_SD: Bounds = Bounds::from(0.0, 0.1, "rad or m (0.1 rad is 5.7°)");
/// Range of the noise of one sample of a log.
const LOG_NOISE: Bounds = Bounds::above(0.0, 1.0, "rad or m");
/// Range of the distance of knots.
const KNOT_STEP: Bounds = Bounds::from(1e-4, 100.0, "s");

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

/// Reads `[machine]`.
pub(super) fn read(section: &Section<'_>, sensor: &Sensor) -> Result<MachinePlan> {
    let source = read_source(section)?;
    let (gravity, gravity_source) = read_gravity(section, false)?;
    let otherwise = MachineSetup::default();
    let mut known = MachineSetup {
        trust: section.get("trust").map_or(Ok(otherwise.trust), |entry| {
            entry.word(&[("noisy", MachineTrust::Noisy), ("known", MachineTrust::Known)])
        })?,
        gravity_mps2: gravity.magnitude_mps2,
        gravity_sd_mps2: gravity.sd_mps2,
        up: section.get("up").map_or(Ok(otherwise.up), |entry| direction(&entry))?,
        tilt_sd_rad: section
            .get("tilt_sd_deg")
            .map_or(Ok(otherwise.tilt_sd_rad), |entry| entry.number(&TILT).map(f64::to_radians))?,
        ..otherwise
    };
    if let Some(mount) = section.section("machine.mount")? {
        read_mount(&mount, &mut known)?;
        if known.mounting == MountingPrior::Unknown && sensor.model != SensorModel::Full {
            let help = "model = \"full\" in [sensor], or a rotation that is known";
            return Err(mount.reject("an unknown mounting needs the full model", help, "rotation"));
        }
    }
    if let Some(clock) = section.section("machine.clock")? {
        let set = |key, bounds, value: &mut f64| set(&clock, key, bounds, value);
        set("delay_s", &DELAY, &mut known.delay_s)?;
        set("delay_sd_s", &DELAY_SD, &mut known.delay_sd_s)?;
        set("delay_difference_sd_s", &DELAY_SD, &mut known.delay_difference_sd_s)?;
        if let Some(entry) = clock.get("rate_sd_ppm") {
            known.clock_rate_sd = entry.number(&RATE_SD)? / 1e6;
        }
    }
    if let Some(geometry) = section.section("machine.geometry")? {
        if source.is_none() {
            let help = "take it out, or name the machine: urdf = … in [machine]";
            return Err(geometry.reject("without a urdf there are no joints", help, ""));
        }
        let set = |key, bounds, value: &mut f64| set(&geometry, key, bounds, value);
        set("translation_sd_m", &TRANSLATION_SD, &mut known.geometry_translation_sd_m)?;
        set("rotation_sd_rad", &ROTATION_SD, &mut known.geometry_rotation_sd_rad)?;
        set("zero_sd", &ZERO_SD, &mut known.zero_sd)?;
    }
    let log = section.section("machine.log")?;
    if let Some(log) = &log {
        known.knot_step_s = log.get("knot_step_s").map(|entry| entry.number(&KNOT_STEP)).transpose()?;
    }
    let simulation = section.section("machine.simulate")?;
    let simulation =
        simulation.map_or(Ok(MachineSimulation::default()), |of| read_simulation(&of, source.is_some()))?;
    let topic = log.as_ref().and_then(|log| log.get("topic"));
    Ok(MachinePlan {
        simulation,
        log_topic: topic.map(|entry| text(&entry)).transpose()?,
        log_noise: log.map_or(Ok(None), |log| read_log_noise(&log, source.is_some()))?,
        source,
        gravity_source,
        noise_of_datasheet: section
            .get("sensor_noise")
            .map_or(Ok(false), |entry| entry.word(&[("residuals", false), ("datasheet", true)]))?,
        known,
    })
}

/// Sets a value where its key is there.
fn set(section: &Section<'_>, key: &str, bounds: &Bounds, value: &mut f64) -> Result<()> {
    if let Some(entry) = section.get(key) {
        *value = entry.number(bounds)?;
    }
    Ok(())
}

fn text(entry: &Entry<'_>) -> Result<String> {
    entry.text().map(str::to_owned).ok_or_else(|| entry.wrong_type("a string", "topic = \"/joint_states\""))
}

fn read_log_noise(section: &Section<'_>, has_joints: bool) -> Result<Option<LogNoise>> {
    let keys = ["position_noise_m", "orientation_noise_rad"];
    let [position, orientation] = keys.map(|key| section.get(key));
    let noise = section.get("noise");
    let of_other = if has_joints { position.as_ref().or(orientation.as_ref()) } else { noise.as_ref() };
    if let Some(entry) = of_other {
        let (message, help) = match has_joints {
            true => ("a log of joints has no poses", "noise = 1e-5, for example: rad or m of one sample"),
            false => ("without a urdf the log has poses", "position_noise_m and orientation_noise_rad"),
        };
        return Err(entry.reject(message, help));
    }
    match (noise, position, orientation) {
        (Some(entry), _, _) => of_joints(&entry).map(Some),
        (None, None, None) => Ok(None),
        (None, Some(position), Some(orientation)) => Ok(Some(LogNoise::OfPoses {
            position_m: position.number(&LOG_NOISE)?,
            orientation_rad: orientation.number(&LOG_NOISE)?,
        })),
        (None, position, _) => {
            Err(section.missing(keys[usize::from(position.is_some())], "give both, or neither"))
        }
    }
}

/// A number for all joints, or one for each.
fn of_joints(entry: &Entry<'_>) -> Result<LogNoise> {
    if !entry.is_array() {
        return entry.number(&LOG_NOISE).map(LogNoise::OfEachJoint);
    }
    let noise = entry.items("")?.iter().map(|item| item.number(&LOG_NOISE)).collect::<Result<_>>()?;
    Ok(LogNoise::OfJoints(noise))
}

/// Refuses the datasheets' noise where one of them does not state it.
pub(super) fn check_noise(section: &Section<'_>, sensor: &Sensor, imu: Option<&ImuPlan>) -> Result<()> {
    let Some(entry) = section.get("sensor_noise").filter(|entry| entry.text() == Some("datasheet")) else {
        return Ok(());
    };
    let missing = if sensor.noise_mps2.is_none() && sensor.noise_counts.is_none() {
        "noise_mps2 (or noise_counts) in [sensor]"
    } else if imu.is_some_and(|imu| imu.gyroscope.noise.is_none()) {
        "noise_radps (or noise_counts) in [gyroscope]"
    } else {
        return Ok(());
    };
    Err(entry.reject(format!("\"datasheet\" needs {missing}"), "add it, or write \"residuals\""))
}
