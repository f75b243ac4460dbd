//! The settings of a simulated IMU recording: holds, turns, gravity, noise, units and temperature;
//! and the stimuli of the motion that they describe.

use super::Rng;
use super::recording::normal;
use crate::sensor::{ImuParameters, ImuRecording, ReadingUnit, Recording, SensorKind, USUAL_NOISE_MPS2};
use nalgebra::Vector3;

/// Duration of a turn by hand from one hold to the next, s.
pub const TURN_S: f64 = 2.0;

/// The conditions of the simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct ImuSimulation {
    /// Number of holds.
    pub poses: usize,
    /// Directions of the holds by hand, in this order (up, unit vectors in the true frame): at least one.
    /// `None`: as many random ones as `poses` says.
    pub directions: Option<Vec<Vector3<f64>>>,
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
            directions: None,
            hold_s: 2.5,
            turn_s: TURN_S,
            rate_hz: 100.0,
            gravity_mps2: 9.806_65,
            accelerometer_noise: USUAL_NOISE_MPS2,
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

/// The stimuli of both sensors, sample by sample.
#[derive(Default)]
pub(super) struct Stimuli {
    times_s: Vec<f64>,
    /// Specific force, m/s².
    forces: Vec<Vector3<f64>>,
    /// Angular rate, rad/s.
    rates: Vec<Vector3<f64>>,
}

impl Stimuli {
    pub(super) fn len(&self) -> usize {
        self.times_s.len()
    }

    pub(super) fn push(&mut self, time_s: f64, force: Vector3<f64>, rate: Vector3<f64>) {
        self.times_s.push(time_s);
        self.forces.push(force);
        self.rates.push(rate);
    }

    /// Adds to the forces in each of these intervals of time (start and end, s) a disturbance of its own.
    pub(super) fn disturb(&mut self, holds: impl Iterator<Item = (f64, f64)>, sd_mps2: f64, rng: &mut Rng) {
        if sd_mps2 <= 0.0 {
            return;
        }
        for (start_s, end_s) in holds {
            let disturbance = Vector3::from_fn(|_, _| sd_mps2 * normal(rng));
            let first = self.times_s.partition_point(|t| *t < start_s);
            let end = self.times_s.partition_point(|t| *t < end_s);
            self.forces[first..end].iter_mut().for_each(|force| *force += disturbance);
        }
    }

    /// The readings of both sensors at the temperature of each sample. The noise of the accelerometer is
    /// drawn first, then that of the gyroscope.
    pub(super) fn record(self, imu: &ImuParameters, setup: &ImuSimulation, rng: &mut Rng) -> ImuRecording {
        let samples = 0..self.len();
        let last = self.len().saturating_sub(1).max(1) as f64;
        let temperature_c: Option<Vec<f64>> = setup
            .temperature_c
            .map(|[from, to]| samples.clone().map(|k| from + (to - from) * (k as f64 / last)).collect());
        let at = |k: usize| temperature_c.as_ref().map_or(*imu, |temperature| imu.at(temperature[k]));
        let mut noisy = |reading: Vector3<f64>, sd: f64| reading + Vector3::from_fn(|_, _| sd * normal(rng));
        let accelerometer: Vec<_> = samples
            .clone()
            .map(|k| {
                noisy(at(k)[SensorKind::Accelerometer].reading(&self.forces[k]), setup.accelerometer_noise)
            })
            .collect();
        let gyroscope: Vec<_> = samples
            .map(|k| {
                let felt = imu.g_sensitivity * self.forces[k];
                noisy(at(k)[SensorKind::Gyroscope].reading(&self.rates[k]) + felt, setup.gyroscope_noise)
            })
            .collect();
        let recording = |times_s: Vec<f64>, readings, unit: ReadingUnit| {
            Some(Recording { times_s, readings, axes: 3, unit })
        };
        ImuRecording {
            sensors: [
                recording(self.times_s.clone(), accelerometer, setup.accelerometer_unit),
                recording(self.times_s, gyroscope, setup.gyroscope_unit),
            ]
            .into(),
            temperature_c,
        }
    }
}
