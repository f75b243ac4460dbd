//! The settings of a simulated IMU recording: holds, turns, gravity, noise, units and temperature.

use crate::sensor::ReadingUnit;
use nalgebra::Vector3;

/// Duration of a turn by hand from one hold to the next, s.
pub const TURN_S: f64 = 2.0;

/// The conditions of the simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct ImuSimulation {
    /// Number of holds.
    pub poses: usize,
    /// Duration of a hold, s.
    pub hold_s: f64,
    /// Duration of the turn between two holds, s.
    pub turn_s: f64,
    /// Sample rate, Hz.
    pub rate_hz: f64,
    /// Gravity, m/s².
    pub gravity_mps2: f64,
    /// Noise of one accelerometer sample, in the unit of its readings.
    pub accelerometer_noise: f64,
    /// Standard deviation of a disturbance of the accelerometer that is constant over a hold, m/s².
    pub between_holds_sd_mps2: f64,
    /// Noise of one gyroscope sample, in the unit of its readings.
    pub gyroscope_noise: f64,
    /// Unit of the accelerometer's readings.
    pub accelerometer_unit: ReadingUnit,
    /// Unit of the gyroscope's readings.
    pub gyroscope_unit: ReadingUnit,
    /// Standard deviation of the face alignment: tilt of the sensor on a face, about each axis, rad.
    pub face_sd_rad: f64,
    /// Earth's rate in a frame whose z axis is up ([`earth_rate`](crate::motion::earth_rate) at a latitude),
    /// rad/s. Zero for an Earth that does not turn.
    pub earth_rate_radps: Vector3<f64>,
    /// Temperature at the beginning and at the end, °C, linear in between. `None` for an IMU at its reference
    /// temperature, whose recording has no temperature.
    pub temperature_c: Option<[f64; 2]>,
}

impl Default for ImuSimulation {
    fn default() -> Self {
        Self {
            poses: 24,
            hold_s: 2.5,
            turn_s: TURN_S,
            rate_hz: 100.0,
            gravity_mps2: 9.806_65,
            accelerometer_noise: 0.01,
            between_holds_sd_mps2: 0.0,
            gyroscope_noise: 2e-3,
            accelerometer_unit: ReadingUnit::MetrePerSecondSquared,
            gyroscope_unit: ReadingUnit::RadianPerSecond,
            face_sd_rad: 0.0,
            earth_rate_radps: Vector3::zeros(),
            temperature_c: None,
        }
    }
}
