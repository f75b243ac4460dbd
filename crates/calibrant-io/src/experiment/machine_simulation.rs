//! `[machine.simulate]`: the settings that only a simulation needs.

use super::number::within;
use super::ranges::{JointAcceleration, MachineDuration, Rate, Resolution, Vibration};
use serde::{Deserialize, Serialize};

/// `[machine.simulate]`: a simulation on a machine. Only joints have encoders.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MachineSimulation {
    /// Duration of the recording, s.
    #[serde(deserialize_with = "within::<MachineDuration, _>")]
    pub duration_s: f64,
    /// Sample rate of the IMU, Hz.
    #[serde(deserialize_with = "within::<Rate, _>")]
    pub rate_hz: f64,
    /// Sample rate of the log, Hz.
    #[serde(deserialize_with = "within::<Rate, _>")]
    pub log_rate_hz: f64,
    /// Largest acceleration of each joint, rad/s² or m/s².
    #[serde(deserialize_with = "within::<JointAcceleration, _>")]
    pub acceleration: f64,
    /// Step of the encoders, rad or m; 0 for none.
    #[serde(deserialize_with = "within::<Resolution, _>")]
    pub resolution: f64,
    /// Noise that vibration adds in the mean, in parts of the noise at rest.
    #[serde(deserialize_with = "within::<Vibration, _>")]
    pub vibration: f64,
}

impl Default for MachineSimulation {
    fn default() -> Self {
        Self {
            duration_s: 60.0,
            rate_hz: 200.0,
            log_rate_hz: 200.0,
            acceleration: 5.0,
            resolution: 0.0,
            vibration: 0.0,
        }
    }
}
