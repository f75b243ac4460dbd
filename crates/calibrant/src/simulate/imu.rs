//! Recordings of an IMU that is held still in several orientations and turned by hand in between.

use super::Rng;
use crate::sensor::{ImuParameters, ImuRecording, ReadingUnit, Recording};
use nalgebra::{UnitQuaternion, Vector3};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

/// What is simulated.
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
    /// Noise of one gyroscope sample, in the unit of its readings.
    pub gyroscope_noise: f64,
    /// Unit of the accelerometer's readings.
    pub accelerometer_unit: ReadingUnit,
    /// Unit of the gyroscope's readings.
    pub gyroscope_unit: ReadingUnit,
    /// Temperature at the beginning and at the end, °C, even in between; `None` for an IMU at its reference temperature, of which nothing is recorded.
    pub temperature_c: Option<[f64; 2]>,
}

impl Default for ImuSimulation {
    fn default() -> Self {
        Self {
            poses: 24,
            hold_s: 2.5,
            turn_s: 2.0,
            rate_hz: 100.0,
            gravity_mps2: 9.806_65,
            accelerometer_noise: 0.01,
            gyroscope_noise: 2e-3,
            accelerometer_unit: ReadingUnit::MetrePerSecondSquared,
            gyroscope_unit: ReadingUnit::RadianPerSecond,
            temperature_c: None,
        }
    }
}

/// The recording of an IMU that is turned from each random orientation to the next, about an axis that wobbles, and held still there.
///
/// The attitude is integrated at sixteen steps for each sample, so the rates and the directions belong together to about 1e-9 rad.
pub fn simulate_imu(imu: &ImuParameters, setup: &ImuSimulation, rng: &mut Rng) -> ImuRecording {
    const FINE: usize = 16;
    let samples = |duration: f64| (duration * setup.rate_hz).round().max(1.0) as usize;
    let step = 1.0 / setup.rate_hz;
    let up = Vector3::new(0.0, 0.0, setup.gravity_mps2);
    let normal = |rng: &mut Rng| -> f64 { StandardNormal.sample(rng) };
    let random = |rng: &mut Rng| Vector3::from_fn(|_, _| normal(rng));
    let mut world_from_sensor = UnitQuaternion::from_scaled_axis(random(rng));
    let (mut times_s, mut forces, mut rates) = (Vec::new(), Vec::new(), Vec::new());
    let mut emit = |attitude: &UnitQuaternion<f64>, rate: Vector3<f64>| {
        times_s.push(times_s.len() as f64 * step);
        forces.push(attitude.inverse() * up);
        rates.push(rate);
    };
    for pose in 0..setup.poses {
        for _ in 0..samples(setup.hold_s) {
            emit(&world_from_sensor, Vector3::zeros());
        }
        if pose + 1 == setup.poses {
            break;
        }
        let axis = random(rng).normalize();
        let wobble = axis.cross(&random(rng)) * 0.3;
        let angle = rng.random_range(1.0..3.0);
        let count = samples(setup.turn_s);
        // a bell that begins and ends at rest, and a wobble across it
        let rate = |x: f64| {
            let bell = 1.0 - (std::f64::consts::TAU * x).cos();
            let swing = (2.0 * std::f64::consts::TAU * x).sin() * bell;
            (axis * bell + wobble * swing) * (angle / (count as f64 * step))
        };
        for k in 0..count {
            emit(&world_from_sensor, rate(k as f64 / count as f64));
            for fine in 0..FINE {
                let x = (k as f64 + (fine as f64 + 0.5) / FINE as f64) / count as f64;
                world_from_sensor *= UnitQuaternion::from_scaled_axis(rate(x) * (step / FINE as f64));
            }
        }
    }
    let last = (times_s.len() - 1).max(1) as f64;
    let temperature_c: Option<Vec<f64>> = setup
        .temperature_c
        .map(|[from, to]| (0..times_s.len()).map(|k| from + (to - from) * (k as f64 / last)).collect());
    let at = |k: usize| temperature_c.as_ref().map_or(*imu, |temperature| imu.at(temperature[k]));
    let noisy =
        |reading: Vector3<f64>, sd: f64, rng: &mut Rng| reading + Vector3::from_fn(|_, _| sd * normal(rng));
    let accelerometer: Vec<_> = forces
        .iter()
        .enumerate()
        .map(|(k, force)| noisy(at(k).accelerometer.reading(force), setup.accelerometer_noise, rng))
        .collect();
    let gyroscope: Vec<_> = rates
        .iter()
        .zip(&forces)
        .enumerate()
        .map(|(k, (rate, force))| {
            noisy(at(k).gyroscope.reading(rate) + imu.g_sensitivity * force, setup.gyroscope_noise, rng)
        })
        .collect();
    let recording = |readings, unit| Recording { times_s: times_s.clone(), readings, axes: 3, unit };
    ImuRecording {
        accelerometer: Some(recording(accelerometer, setup.accelerometer_unit)),
        gyroscope: Some(recording(gyroscope, setup.gyroscope_unit)),
        temperature_c,
    }
}
