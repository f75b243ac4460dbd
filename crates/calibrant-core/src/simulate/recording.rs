//! Simulated recordings of a commanded motion, with process noise, measurement noise
//! and the gravity that a tilted sensor senses.

use super::Rng;
use crate::form::As;
use crate::motion::{InputNoise, JerkControlledMotion, KnownEnds, MotionGravity};
use crate::sensor::{ReadingUnit, Recording, SensorParameters};
use nalgebra::{Rotation3, Vector3};
use rand_distr::{Distribution, StandardNormal};
use schemars::JsonSchema;
use serde::Serialize;

/// The motion that happens when this one is commanded. Process noise `w_i ~ N(0, σ_u(u_i)²)` acts on each
/// interval's jerk, the thesis's `ū_i = u_i + w_i`.
///
/// Where both ends are known, the walk is drawn on the condition that it ends where it was commanded to (a
/// bridge). The deviation at the end is distributed over the nodes, in proportion to the variance of the
/// increments up to each.
///
/// # Errors
/// As [`JerkControlledMotion::new`], where the noise is not finite.
pub fn perturb(
    command: &JerkControlledMotion,
    noise: &InputNoise,
    axes: usize,
    known_ends: KnownEnds,
    rng: &mut Rng,
) -> crate::Result<JerkControlledMotion> {
    let mut a = command.acceleration_mps2()[0];
    let mut nodes = vec![a];
    for (i, u) in command.jerk_mps3().iter().enumerate() {
        let sd = noise.sd(u);
        let w = Vector3::from_fn(|k, _| if k < axes { sd[k] * normal(rng) } else { 0.0 });
        a += (u + w) * command.interval_s(i);
        nodes.push(a);
    }
    if known_ends == KnownEnds::Both {
        let deviation = a - command.acceleration_mps2()[command.intervals()];
        let variances: Vec<Vector3<f64>> = command
            .jerk_mps3()
            .iter()
            .enumerate()
            .map(|(i, u)| (noise.sd(u) * command.interval_s(i)).map(|sd| sd * sd))
            .collect();
        let total: Vector3<f64> = variances.iter().sum();
        let mut passed = Vector3::zeros();
        for (node, variance) in nodes[1..].iter_mut().zip(&variances) {
            passed += variance;
            *node -= Vector3::from_fn(
                |k, _| if total[k] > 0.0 { deviation[k] * passed[k] / total[k] } else { 0.0 },
            );
        }
    }
    JerkControlledMotion::new(command.times_s().to_vec(), nodes)
}

/// The recording of a motion by a sensor: `y_k = S α(t_k) + b + ν_k`, `ν_k ~ N(0, σ_ν²)` per axis. The noise
/// is in the unit of the readings.
#[must_use]
pub fn simulate_recording(
    sensor: &SensorParameters,
    noise: &Vector3<f64>,
    unit: ReadingUnit,
    axes: usize,
    motion: &JerkControlledMotion,
    times_s: &[f64],
    rng: &mut Rng,
) -> Recording {
    let nodes = motion.acceleration_mps2();
    let readings: Vec<_> = nodes.iter().map(|a| sensor.reading(a)).collect();
    let tau = motion.times_s();
    let mut i = 0;
    let readings = times_s
        .iter()
        .map(|&t| {
            while i + 1 < motion.intervals() && t >= tau[i + 1] {
                i += 1;
            }
            let lambda = ((t - tau[i]) / (tau[i + 1] - tau[i])).clamp(0.0, 1.0);
            let clean = readings[i] * (1.0 - lambda) + readings[i + 1] * lambda;
            Vector3::from_fn(|k, _| if k < axes { clean[k] + noise[k] * normal(rng) } else { 0.0 })
        })
        .collect();
    Recording { times_s: times_s.to_vec(), readings, axes, unit }
}

/// A number of the normal distribution of mean 0 and variance 1.
#[must_use]
pub fn normal(rng: &mut Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// Gravity as it is, where it was only given with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct TrueGravity {
    /// Specific force of the sensor at rest, m/s².
    #[serde(with = "As::<[f64; 3]>")]
    pub force_mps2: Vector3<f64>,
    /// Tilt about each axis, rad.
    #[serde(with = "As::<[f64; 3]>")]
    pub tilt_rad: Vector3<f64>,
}

/// Draws a tilt and a magnitude, and turns gravity by the tilt: exactly, not to first order.
#[must_use]
pub fn draw_gravity(gravity: &MotionGravity, rng: &mut Rng) -> TrueGravity {
    let mut normal = || normal(rng);
    let up = gravity.force_mps2.normalize();
    let any = Vector3::new(normal(), normal(), normal());
    let tilt_rad = (any - up * up.dot(&any)) * gravity.tilt_sd_rad;
    let force = gravity.force_mps2 + up * (gravity.sd_mps2 * normal());
    TrueGravity { force_mps2: Rotation3::new(tilt_rad) * force, tilt_rad }
}
