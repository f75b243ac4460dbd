//! Simulated recordings of an IMU: holds in several orientations, with rotations by hand in between.

use super::imu_setup::Stimuli;
use super::recording::normal;
use super::{ImuSimulation, Rng};
use crate::sensor::{ImuParameters, ImuRecording};
use nalgebra::{UnitQuaternion, Vector3};
use rand::RngExt;

/// The recording of an IMU that is turned from each orientation to the next and held still there: random ones,
/// by turns whose axis wobbles, or the given [directions](ImuSimulation::directions) with a random heading.
///
/// The attitude is integrated at sixteen steps for each sample. So the rates and the directions belong
/// together to about 1e-9 rad.
pub fn simulate_imu(imu: &ImuParameters, setup: &ImuSimulation, rng: &mut Rng) -> ImuRecording {
    /// Integration steps for each sample.
    const FINE: usize = 16;
    let samples = |duration: f64| (duration * setup.rate_hz).round().max(1.0) as usize;
    let step = 1.0 / setup.rate_hz;
    let up = Vector3::new(0.0, 0.0, setup.gravity_mps2);
    let random = |rng: &mut Rng| -> Vector3<f64> { Vector3::from_fn(|_, _| normal(rng)) };
    let poses = setup.directions.as_ref().map_or(setup.poses, Vec::len);
    let mut world_from_sensor = match &setup.directions {
        Some(directions) => facing(&directions[0], rng),
        None => UnitQuaternion::from_scaled_axis(random(rng)),
    };
    let mut stimuli = Stimuli::default();
    let mut emit = |attitude: &UnitQuaternion<f64>, rate: Vector3<f64>| {
        let sensor_from_world = attitude.inverse();
        let of_earth = sensor_from_world * setup.earth_rate_radps;
        stimuli.push(stimuli.len() as f64 * step, sensor_from_world * up, rate + of_earth);
    };
    for pose in 0..poses {
        for _ in 0..samples(setup.hold_s) {
            emit(&world_from_sensor, Vector3::zeros());
        }
        if pose + 1 == poses {
            break;
        }
        let (axis, wobble, angle) = match &setup.directions {
            Some(directions) => {
                let next = facing(&directions[pose + 1], rng);
                let turn = (world_from_sensor.inverse() * next).scaled_axis();
                (turn.try_normalize(0.0).unwrap_or_else(Vector3::zeros), Vector3::zeros(), turn.norm())
            }
            None => {
                let axis = random(rng).normalize();
                let wobble = axis.cross(&random(rng)) * 0.3;
                let angle = rng.random_range(1.0..3.0);
                (axis, wobble, angle)
            }
        };
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
    let hold_s = samples(setup.hold_s) as f64 * step;
    let period_s = hold_s + samples(setup.turn_s) as f64 * step;
    let holds = (0..poses).map(|pose| pose as f64 * period_s - 0.5 * step);
    stimuli.disturb(holds.map(|start| (start, start + hold_s)), setup.between_holds_sd_mps2, rng);
    stimuli.record(imu, setup, rng)
}

/// An attitude (sensor to world) with this direction of the sensor up, and a random heading.
fn facing(up: &Vector3<f64>, rng: &mut Rng) -> UnitQuaternion<f64> {
    let half_a_turn = || UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    let upright = UnitQuaternion::rotation_between(up, &Vector3::z()).unwrap_or_else(half_a_turn);
    let heading = rng.random_range(0.0..std::f64::consts::TAU);
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), heading) * upright
}
