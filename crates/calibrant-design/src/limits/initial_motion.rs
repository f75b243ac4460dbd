//! The initial motion of a design, with prescribed ends where there are any.

use super::{inside, worst_violation};
use calibrant_core::error::Result;
use calibrant_core::motion::{JerkControlledMotion, Limits, Rest};
use calibrant_core::simulate::{Rng, initial_motion as free_initial_motion};
use nalgebra::Vector3;

/// The motion that experience would choose, as
/// [`simulate::initial_motion`](calibrant_core::simulate::initial_motion) has it. On axes with prescribed
/// ends it is the motion furthest from all limits, plus as much of the random one as the limits admit.
///
/// # Errors
/// [`Error::Infeasible`](calibrant_core::Error::Infeasible) where the prescribed ends leave no room; else as
/// [`JerkControlledMotion::uniform`].
pub fn initial_motion(
    intervals: usize,
    interval_s: f64,
    axes: usize,
    limits: &Limits,
    rng: &mut Rng,
) -> Result<JerkControlledMotion> {
    let free = free_initial_motion(intervals, interval_s, axes, limits, rng)?;
    if limits.start_acceleration_mps2.is_none() && limits.end_acceleration_mps2.is_none() {
        return Ok(free);
    }
    let (base, _) = inside(limits, axes, intervals, interval_s)?;
    let times = base.times_s();
    let mut nodes: Vec<Vector3<f64>> = base.acceleration_mps2().to_vec();
    for k in 0..axes {
        let own = limits.axis(k);
        let random: Vec<f64> = free.acceleration_mps2().iter().map(|a| a[k]).collect();
        let step = without_ends(random, own.start.is_some(), own.end.is_some(), own.rest == Rest::Both);
        let moved = |share: f64| -> Vec<f64> {
            nodes.iter().zip(&step).map(|(base, step)| base[k] + share * step).collect()
        };
        // admissible motions are convex, and none of it is admissible
        let (mut good, mut bad) = (0.0, 1.0);
        if worst_violation(&own, times, &moved(bad)) <= 0.0 {
            good = bad;
        }
        for _ in 0..50 {
            let middle = (good + bad) / 2.0;
            if worst_violation(&own, times, &moved(middle)) <= 1e-12 { good = middle } else { bad = middle }
        }
        let moved = moved(good);
        nodes.iter_mut().zip(moved).for_each(|(node, value)| node[k] = value);
    }
    JerkControlledMotion::uniform(interval_s, nodes)
}

/// A motion less a line, so that it begins or ends with zero. Where it must end at rest, also less its mean.
fn without_ends(mut a: Vec<f64>, start: bool, end: bool, rest: bool) -> Vec<f64> {
    let n = a.len() - 1;
    let first = if start { a[0] } else { 0.0 };
    let last = if end { a[n] } else { 0.0 };
    for (i, a) in a.iter_mut().enumerate() {
        let x = i as f64 / n as f64;
        *a -= first * (1.0 - x) + last * x;
    }
    if rest && n > 1 {
        let sum = a.iter().sum::<f64>() - (a[0] + a[n]) / 2.0;
        a[1..n].iter_mut().for_each(|a| *a -= sum / (n - 1) as f64);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::simulate::{Purpose, stream};

    #[test]
    fn prescribed_ends_are_kept_and_the_motion_is_random_in_between() {
        let limits = Limits {
            acceleration_mps2: Some(Vector3::repeat(20.0)),
            jerk_mps3: Some(Vector3::repeat(20.0)),
            velocity_mps: Some(Vector3::repeat(10.0)),
            displacement_m: Some(Vector3::repeat(10.0)),
            rest: Rest::Both,
            start_acceleration_mps2: Some(Vector3::new(0.0, 1.0, -2.0)),
            end_acceleration_mps2: Some(Vector3::new(0.0, -1.0, 2.0)),
            ..Limits::default()
        };
        let draw = |index| {
            initial_motion(10, 1.0, 3, &limits, &mut stream(1, Purpose::Motion, index)).expect("admissible")
        };
        let (one, two) = (draw(0), draw(1));
        assert_ne!(one, two);
        for motion in [&one, &two] {
            assert_eq!(motion.acceleration_mps2()[0], Vector3::new(0.0, 1.0, -2.0));
            assert_eq!(motion.acceleration_mps2()[10], Vector3::new(0.0, -1.0, 2.0));
            for k in 0..3 {
                let a: Vec<f64> = motion.acceleration_mps2().iter().map(|a| a[k]).collect();
                assert!(worst_violation(&limits.axis(k), motion.times_s(), &a) < 1e-9);
            }
        }
    }
}
