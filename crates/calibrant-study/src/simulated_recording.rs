//! One simulated recording of a study: a drawn sensor moves and is recorded.

use calibrant_core::error::Result;
use calibrant_core::motion::{CommandedMotion, JerkControlledMotion, Trust};
use calibrant_core::sensor::{Recording, Sensor, SensorParameters};
use calibrant_core::simulate::{ClockedTimes, Rng, draw_gravity, perturb, simulate_recording};
use nalgebra::Vector3;

/// The motion that really happens when this one is commanded, and the sensor's recording of it.
pub(super) fn record(
    sensor: &Sensor,
    truth: &SensorParameters,
    command: &CommandedMotion,
    rate_hz: f64,
    rng: &mut Rng,
) -> Result<(JerkControlledMotion, Recording)> {
    let happened = match command.trust {
        Trust::Noisy(noise) => perturb(&command.motion, &noise, sensor.axes, command.known_ends, rng)?,
        Trust::Known | Trust::Unknown => command.motion.clone(),
    };
    let noise = sensor.noise(&truth.matrix.diagonal()).unwrap_or_else(Vector3::zeros);
    let sensed = match &command.gravity {
        Some(gravity) => happened.plus(&draw_gravity(gravity, rng).force_mps2)?,
        None => happened.clone(),
    };
    let times = ClockedTimes::draw(&command.motion, rate_hz, &command.clock, rng);
    let recording =
        simulate_recording(truth, &noise, sensor.unit, sensor.axes, &sensed, &times.motion_s, rng);
    Ok((happened, times.on_own_clock(recording)))
}
