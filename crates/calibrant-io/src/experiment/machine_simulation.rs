//! Reads `[machine.simulate]`: the settings that only a simulation needs.

use super::motion::RATE_HZ;
use super::number_range::Bounds;
use super::toml_document::Section;
use calibrant_core::error::Result;

/// Range of the duration. In a shorter time a machine hardly comes home.
const DURATION: Bounds = Bounds::from(10.0, 1e5, "s");
/// Range of the acceleration of a joint.
const ACCELERATION: Bounds = Bounds::above(0.0, 1e3, "rad/s² or m/s²");
/// Range of the step of an encoder.
const RESOLUTION: Bounds = Bounds::from(0.0, 0.1, "rad or m");
/// Range of the noise by vibration over the noise at rest.
const VIBRATION: Bounds = Bounds::from(0.0, 1e3, "");

/// A simulation on a machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineSimulation {
    /// Duration of the recording, s.
    pub duration_s: f64,
    /// Sample rate of the IMU, Hz.
    pub rate_hz: f64,
    /// Sample rate of the log, Hz.
    pub log_rate_hz: f64,
    /// Largest acceleration of each joint, rad/s² or m/s².
    pub acceleration: f64,
    /// Step of the encoders, rad or m; 0 for none.
    pub resolution: f64,
    /// Noise that vibration adds in the mean, in parts of the noise at rest.
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

/// Reads `[machine.simulate]`. Only joints have encoders.
pub(super) fn read_simulation(section: &Section<'_>, has_joints: bool) -> Result<MachineSimulation> {
    if let Some(entry) = section.get("resolution").filter(|_| !has_joints) {
        let help = "take it out, or name the machine: urdf = … in [machine]";
        return Err(entry.reject("without a urdf there are no encoders", help));
    }
    let mut simulation = MachineSimulation::default();
    for (key, bounds, value) in [
        ("duration_s", &DURATION, &mut simulation.duration_s),
        ("rate_hz", &RATE_HZ, &mut simulation.rate_hz),
        ("log_rate_hz", &RATE_HZ, &mut simulation.log_rate_hz),
        ("acceleration", &ACCELERATION, &mut simulation.acceleration),
        ("resolution", &RESOLUTION, &mut simulation.resolution),
        ("vibration", &VIBRATION, &mut simulation.vibration),
    ] {
        if let Some(entry) = section.get(key) {
            *value = entry.number(bounds)?;
        }
    }
    Ok(simulation)
}
