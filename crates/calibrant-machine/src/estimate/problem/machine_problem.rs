//! What is to be calibrated on a machine, and its unknowns in their order.

use crate::chain::KinematicChain;
use crate::estimate::MachineQuantity;
use crate::log::ReferenceLog;
use calibrant_core::error::{Error, InputError, Refusal};
use calibrant_core::estimate::KnownTerm;
use calibrant_core::interruption::Interruption;
use calibrant_core::progress::Progress;
use calibrant_core::sensor::{Gauge, ImuParameters, ImuQuantity, ImuRecording, SensorKind};
use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// A recording of an IMU on a machine, and the log of the machine's motion.
#[derive(Debug, Clone, Copy)]
pub struct MachineProblem<'a> {
    /// The sensor's samples: accelerometer, gyroscope, or both.
    pub recording: &'a ImuRecording,
    /// The log. The columns of a log of joints are in the order of the chain's joints.
    pub log: &'a ReferenceLog,
    /// The chain, for a log of joints.
    pub chain: Option<&'a KinematicChain>,
    /// What is known of machine and mount.
    pub setup: &'a MachineSetup,
    /// The sensor as its datasheet describes it: where the iteration begins.
    pub nominal: &'a ImuParameters,
    /// The sensor's parameters that are estimated.
    pub quantities: &'a [ImuQuantity],
}

/// How to solve it. The defaults serve every problem known to us.
#[derive(Debug, Clone, PartialEq)]
pub struct MachineSettings {
    /// Gauss–Newton steps at most, once the noise is known.
    pub max_iterations: usize,
    /// The iteration ends when a step is shorter than this, in standard deviations of the parameters.
    pub tolerance: f64,
    /// Rounds of the search for the noise at most.
    pub max_noise_rounds: usize,
    /// Ends the calibration without a result.
    pub interruption: Interruption,
    /// Is told of each round and each step.
    pub progress: Progress,
}

impl Default for MachineSettings {
    fn default() -> Self {
        Self {
            max_iterations: 30,
            tolerance: 1e-2,
            max_noise_rounds: 25,
            interruption: Interruption::default(),
            progress: Progress::default(),
        }
    }
}

/// How far the log of the machine's motion is trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MachineTrust {
    /// The log measures the motion with noise, and the sensor helps to find it.
    Noisy,
    /// The smoothed log is exact.
    Known,
}

/// What is known of the sensor's orientation on the tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MountingPrior {
    /// A fixture defines it: it is not estimated.
    Exact,
    /// It is known with this standard deviation about each axis, rad.
    Within(f64),
    /// It is found from the data. It cannot be told from a rotation of the sensor's matrices, so the accelerometer's is upper triangular
    /// (the gyroscope's where it is alone).
    Unknown,
}

/// What is known beforehand. A standard deviation of 0 holds a quantity at its value; an infinite one leaves it to the data.
///
/// # Examples
/// ```
/// use calibrant_machine::estimate::{MachineSetup, MountingPrior};
/// let setup = MachineSetup { lever_sd_m: 0.0, mounting: MountingPrior::Exact, ..MachineSetup::default() };
/// assert_eq!(setup.gravity_mps2, 9.80665);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MachineSetup {
    /// Trust in the log.
    pub trust: MachineTrust,
    /// Magnitude of gravity, m/s².
    pub gravity_mps2: f64,
    /// Its standard uncertainty, m/s².
    pub gravity_sd_mps2: f64,
    /// The direction up in the base frame (or in the tracker's world).
    pub up: Vector3<f64>,
    /// Standard deviation of that direction about each of two axes, rad.
    pub tilt_sd_rad: f64,
    /// Nominal lever arm from the tip to the sensor, in the axes of the tip, m.
    pub lever_m: Vector3<f64>,
    /// Its standard deviation along each axis, m.
    pub lever_sd_m: f64,
    /// Nominal rotation from the sensor's frame to that of the tip.
    pub tip_from_sensor: UnitQuaternion<f64>,
    /// How well it is known.
    pub mounting: MountingPrior,
    /// Nominal delay, s: motion time = IMU time + delay.
    pub delay_s: f64,
    /// Standard deviation of the delay that both sensors share, s.
    pub delay_sd_s: f64,
    /// Standard deviation of the difference between the sensors' delays, s.
    pub delay_difference_sd_s: f64,
    /// Standard deviation of the relative rate of the two clocks.
    pub clock_rate_sd: f64,
    /// Standard deviation of the translations in the joints' transforms, m.
    pub geometry_translation_sd_m: f64,
    /// Standard deviation of the rotations in the joints' transforms, rad.
    pub geometry_rotation_sd_rad: f64,
    /// Standard deviation of the joints' zero offsets, rad or m.
    pub zero_sd: f64,
    /// Distance of the knots of a cubic spline, s: that of the waypoints which the machine was given. `None`: a quintic spline whose knots
    /// follow the bandwidth of the data.
    pub knot_step_s: Option<f64>,
    /// Noise of one sample of the accelerometer, in the unit of its readings. `None`: from the residuals.
    pub accelerometer_noise: Option<Vector3<f64>>,
    /// Noise of one sample of the gyroscope, in the unit of its readings. `None`: from the residuals.
    pub gyroscope_noise: Option<Vector3<f64>>,
    /// Noise of one sample of the log: of each joint in rad or m, or of position (3 axes, m) and orientation (3 axes, rad). `None`: from the residuals.
    pub reference_noise: Option<Vec<f64>>,
    /// Parameters of the sensor that are known: held at their values, or within a standard deviation of them.
    pub known: Vec<KnownTerm>,
}

impl MountingPrior {
    /// The gauge of the first sensor's matrix where the mounting is unknown.
    pub const GAUGE: Gauge = Gauge::Upper;
}

impl MachineSetup {
    /// Standard deviation of what is known of a quantity beforehand, with this number of sensors: 0 where it is held, infinite where nothing is
    /// known, as of most parameters of the IMU.
    #[must_use]
    pub fn prior_sd(&self, quantity: MachineQuantity, sensors: usize) -> f64 {
        match quantity {
            MachineQuantity::Imu(of) => (self.known.iter().find(|known| known.quantity == of))
                .map_or(f64::INFINITY, |known| known.sd.unwrap_or(0.0)),
            MachineQuantity::Lever(_) => self.lever_sd_m,
            MachineQuantity::Mounting(_) => match self.mounting {
                MountingPrior::Within(sd_rad) => sd_rad,
                MountingPrior::Exact => 0.0,
                MountingPrior::Unknown => f64::INFINITY,
            },
            // without gravity there is nothing to tilt
            MachineQuantity::Tilt(_) if self.gravity_mps2 == 0.0 => 0.0,
            MachineQuantity::Tilt(_) => self.tilt_sd_rad,
            MachineQuantity::Gravity => self.gravity_sd_mps2,
            // the mean of both delays, and half their difference
            MachineQuantity::Delay(_) if sensors > 1 && self.delay_sd_s > 0.0 => {
                self.delay_sd_s.hypot(0.5 * self.delay_difference_sd_s)
            }
            MachineQuantity::Delay(_) => self.delay_sd_s,
            MachineQuantity::ClockRate => self.clock_rate_sd,
            MachineQuantity::Zero(_) => self.zero_sd,
            MachineQuantity::Geometry(_, k) if k < 3 => self.geometry_translation_sd_m,
            MachineQuantity::Geometry(..) => self.geometry_rotation_sd_rad,
        }
    }

    /// The noise that is given for a sensor.
    #[must_use]
    pub fn noise_of(&self, sensor: SensorKind) -> Option<Vector3<f64>> {
        match sensor {
            SensorKind::Accelerometer => self.accelerometer_noise,
            SensorKind::Gyroscope => self.gyroscope_noise,
        }
    }
}

impl Default for MachineSetup {
    fn default() -> Self {
        Self {
            trust: MachineTrust::Noisy,
            gravity_mps2: 9.80665,
            gravity_sd_mps2: 0.0,
            up: Vector3::z(),
            tilt_sd_rad: 0.5_f64.to_radians(),
            lever_m: Vector3::zeros(),
            lever_sd_m: 2e-3,
            tip_from_sensor: UnitQuaternion::identity(),
            mounting: MountingPrior::Within(0.5_f64.to_radians()),
            delay_s: 0.0,
            delay_sd_s: 50e-3,
            delay_difference_sd_s: 5e-3,
            clock_rate_sd: 100e-6,
            geometry_translation_sd_m: 3e-4,
            geometry_rotation_sd_rad: 3e-4,
            zero_sd: 3e-4,
            knot_step_s: None,
            accelerometer_noise: None,
            gyroscope_noise: None,
            reference_noise: None,
            known: Vec::new(),
        }
    }
}

pub(crate) fn refused(message: impl Into<String>, help: &str) -> Error {
    Error::recording(InputError::new(Refusal::MachineUnsolved, message, help))
}

/// The equations cannot be solved: a value is not finite, or nothing is determined.
pub(crate) fn unsolved() -> Error {
    refused(
        "the recording does not fit the log of the machine: the equations have no solution",
        "check that both are of the same motion, the units, the order of the joints, and the mounting",
    )
}
