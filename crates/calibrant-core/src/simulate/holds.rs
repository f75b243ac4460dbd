//! Simulated recordings of a sensor: holds in several orientations, with rotations by hand in between.

use super::Rng;
use super::recording::normal;
use crate::sensor::{ReadingUnit, Recording, SensorParameters};
use nalgebra::{UnitQuaternion, Vector3};
use rand::seq::SliceRandom;

/// The conditions of the simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldsSimulation {
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
    /// Standard deviation of a disturbance that is constant over a hold (a table that is not quite still, a drifting temperature), m/s².
    pub between_holds_sd_mps2: f64,
}

/// The recording of a sensor in orientations spread evenly over the sphere, and the true specific force in
/// each hold, m/s². The orientations are a Fibonacci lattice, turned at random, in random order: a drift then looks like no parameter.
pub fn simulate_holds(
    sensor: &SensorParameters,
    noise: &Vector3<f64>,
    unit: ReadingUnit,
    setup: &HoldsSimulation,
    rng: &mut Rng,
) -> (Recording, Vec<Vector3<f64>>) {
    let mut part = || normal(rng);
    let frame = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(part(), part(), part(), part()));
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let mut directions: Vec<Vector3<f64>> = (0..setup.poses)
        .map(|j| {
            let z = 1.0 - (2.0 * j as f64 + 1.0) / setup.poses as f64;
            let (sin, cos) = (golden * j as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            frame * Vector3::new(r * cos, r * sin, z)
        })
        .collect();
    directions.shuffle(rng);
    simulate_holds_in(sensor, noise, unit, &directions, setup, rng)
}

/// The recording of a sensor in these directions (up, unit vectors in the true frame), in this order, and the
/// true specific force in each hold, m/s². `setup.poses` is not used.
pub fn simulate_holds_in(
    sensor: &SensorParameters,
    noise: &Vector3<f64>,
    unit: ReadingUnit,
    directions: &[Vector3<f64>],
    setup: &HoldsSimulation,
    rng: &mut Rng,
) -> (Recording, Vec<Vector3<f64>>) {
    let mut normal = || normal(rng);
    let forces: Vec<_> = directions.iter().map(|direction| direction * setup.gravity_mps2).collect();
    let samples = |duration: f64| (duration * setup.rate_hz).round().max(1.0) as usize;
    let (mut times_s, mut readings) = (Vec::new(), Vec::new());
    for (j, force) in forces.iter().enumerate() {
        let disturbance = Vector3::from_fn(|_, _| setup.between_holds_sd_mps2 * normal());
        let mut emit = |force: &Vector3<f64>| {
            times_s.push(times_s.len() as f64 / setup.rate_hz);
            readings.push(sensor.reading(force) + Vector3::from_fn(|k, _| noise[k] * normal()));
        };
        for _ in 0..samples(setup.hold_s) {
            emit(&(force + disturbance));
        }
        if let Some(next) = forces.get(j + 1) {
            let turn = UnitQuaternion::rotation_between(force, next).unwrap_or_else(|| {
                UnitQuaternion::from_axis_angle(
                    &nalgebra::Unit::new_normalize(perpendicular(force)),
                    std::f64::consts::PI,
                )
            });
            let steps = samples(setup.turn_s);
            for step in 0..steps {
                let x = (step as f64 + 0.5) / steps as f64;
                // smooth start and stop, with the hand's own acceleration on top
                let done = x * x * (3.0 - 2.0 * x);
                let swing = (std::f64::consts::TAU * 2.0 * x).sin() * (std::f64::consts::PI * x).sin();
                let tilted = UnitQuaternion::identity().slerp(&turn, done) * force;
                emit(&(tilted + Vector3::new(1.5, -1.0, 0.8) * swing));
            }
        }
    }
    (Recording { times_s, readings, axes: 3, unit }, forces)
}

fn perpendicular(v: &Vector3<f64>) -> Vector3<f64> {
    v.cross(&if v.x.abs() < 0.7 * v.norm() { Vector3::x() } else { Vector3::y() })
}
