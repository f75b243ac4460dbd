//! The initial motion that experience would choose. Every design is compared with it.

use super::Rng;
use crate::motion::{JerkControlledMotion, Limits, Rest};
use nalgebra::Vector3;
use rand::RngExt;

/// Largest acceleration and jerk where no limit is given: the thesis's ±30 m/s² and m/s³.
const DEFAULT_LIMIT: f64 = 30.0;

/// A random motion on each of `axes` axes, shrunk into the limits: jerk `u_i ~ U(−1, 1) u_max/10`, start
/// `a_0 ~ U(−1, 1) a_max/10`.
///
/// All limits are linear in the motion, so shrinking means multiplying each axis by one factor. Velocity and
/// displacement are bounded by their Bézier control points, which holds between the nodes too. For rest at
/// the end, the mean acceleration is subtracted first. Where the acceleration has no limit, that of the
/// intercept counts for the draw. Limits that are not given count as ±30 (m/s², m/s³) for the draw and do not
/// bind.
///
/// # Errors
/// As [`JerkControlledMotion::uniform`].
pub fn initial_motion(
    intervals: usize,
    interval_s: f64,
    axes: usize,
    limits: &Limits,
    rng: &mut Rng,
) -> crate::Result<JerkControlledMotion> {
    // the first interval's line begins at its intercept
    let a_max =
        limits.acceleration_mps2.or(limits.intercept_mps2).unwrap_or_else(|| Vector3::repeat(DEFAULT_LIMIT));
    let u_max = limits.jerk_mps3.unwrap_or_else(|| Vector3::repeat(DEFAULT_LIMIT));
    let mut draw = |limit: &Vector3<f64>| {
        Vector3::from_fn(|k, _| {
            let u: f64 = rng.random_range(-1.0..1.0);
            if k < axes { u * limit[k] / 10.0 } else { 0.0 }
        })
    };
    let mut a = draw(&a_max);
    let mut nodes = vec![a];
    for _ in 0..intervals {
        a += draw(&u_max) * interval_s;
        nodes.push(a);
    }
    if limits.rest == Rest::Both {
        let mean =
            (nodes.iter().sum::<Vector3<f64>>() - (nodes[0] + nodes[intervals]) * 0.5) / intervals as f64;
        nodes.iter_mut().for_each(|node| *node -= mean);
    }
    let raw = JerkControlledMotion::uniform(interval_s, nodes)?;
    let factor = Vector3::from_fn(|k, _| if k < axes { shrink(&raw, limits, k) } else { 1.0 });
    let nodes = raw.acceleration_mps2().iter().map(|node| node.component_mul(&factor)).collect();
    JerkControlledMotion::uniform(interval_s, nodes)
}

/// The largest factor up to one that brings axis k within the limits.
fn shrink(motion: &JerkControlledMotion, limits: &Limits, k: usize) -> f64 {
    let peak = |values: &[Vector3<f64>]| values.iter().fold(0.0_f64, |peak, v| peak.max(v[k].abs()));
    let mut factor = 1.0_f64;
    let mut within = |limit: &Option<Vector3<f64>>, peak: f64| {
        if let Some(limit) = limit
            && peak > 0.0
        {
            factor = factor.min(limit[k] / peak);
        }
    };
    within(&limits.acceleration_mps2, peak(motion.acceleration_mps2()));
    within(&limits.jerk_mps3, peak(&motion.jerk_mps3()));
    within(&limits.intercept_mps2, peak(&motion.intercept_mps2()));
    let (a, v, d) = (motion.acceleration_mps2(), motion.velocity_mps(), motion.displacement_m());
    let (mut velocity, mut displacement) = (v.clone(), d.clone());
    for i in 0..motion.intervals() {
        let dt = motion.interval_s(i);
        velocity.push(v[i] + a[i] * (dt / 2.0));
        displacement.push(d[i] + v[i] * (dt / 3.0));
        displacement.push(d[i + 1] - v[i + 1] * (dt / 3.0));
    }
    within(&limits.velocity_mps, peak(&velocity));
    within(&limits.displacement_m, peak(&displacement));
    factor
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Purpose, stream};

    #[test]
    fn the_initial_motion_keeps_every_limit_between_the_nodes_too() {
        let limits = Limits {
            acceleration_mps2: Some(Vector3::new(30.0, 20.0, 1.0)),
            jerk_mps3: Some(Vector3::repeat(30.0)),
            intercept_mps2: Some(Vector3::repeat(25.0)),
            velocity_mps: Some(Vector3::new(10.0, 5.0, 2.0)),
            displacement_m: Some(Vector3::repeat(8.0)),
            rest: Rest::Both,
            ..Limits::default()
        };
        for index in 0..50 {
            let motion =
                initial_motion(10, 1.0, 3, &limits, &mut stream(7, Purpose::Motion, index)).expect("valid");
            assert!(motion.velocity_mps()[10].amax() < 1e-12, "at rest at the end");
            let (mut v, mut d) = (Vector3::zeros(), Vector3::zeros());
            let dt = 1e-3;
            for step in 0..10_000 {
                let a = motion.acceleration_at((f64::from(step) + 0.5) * dt);
                d += v * dt;
                v += a * dt;
                for k in 0..3 {
                    assert!(a[k].abs() <= limits.acceleration_mps2.expect("set")[k] * (1.0 + 1e-12));
                    assert!(v[k].abs() <= limits.velocity_mps.expect("set")[k] * 1.001);
                    assert!(d[k].abs() <= 8.0 * 1.01);
                }
            }
        }
    }
}
