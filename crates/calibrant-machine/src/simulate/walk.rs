//! One coordinate that goes from way-point to way-point within its limits.
//!
//! The control points of a uniform B-spline bound it: the value lies in their hull, the velocity in that of their differences, and so on. So what holds for
//! control points holds at any time.

use crate::spline::UniformKnots;
use calibrant_core::simulate::Rng;
use rand::RngExt;

/// Longest stop at a way-point, s.
const LONGEST_STOP_S: f64 = 0.4;
/// Smallest part of the largest speed that a move has.
const SLOWEST: f64 = 0.3;

/// What a coordinate keeps to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WalkLimits {
    pub(super) lower: f64,
    pub(super) upper: f64,
    /// Largest velocity, 1/s.
    pub(super) speed: f64,
    /// Largest acceleration, 1/s².
    pub(super) acceleration: f64,
}

/// Control points of a walk between random way-points. It begins and ends in the middle, at rest for `rest_s`. Each move has a speed of its own. What
/// cannot move stays there.
pub(super) fn walk(limits: &WalkLimits, knots: UniformKnots, rest_s: f64, rng: &mut Rng) -> Vec<f64> {
    let WalkLimits { lower, upper, speed, acceleration } = *limits;
    let (h, home) = (knots.step_s, 0.5 * (lower + upper));
    if !(upper > lower && speed > 0.0 && acceleration > 0.0) {
        return vec![home; knots.controls()];
    }
    let still = (rest_s / h).ceil() as usize + knots.degree.order();
    let count = knots.controls();
    let way_back_s = 0.5 * (upper - lower) / speed + 2.0 * speed / acceleration;
    let way_back = (way_back_s / h).ceil() as usize + still;
    let mut controls = Vec::with_capacity(count);
    let (mut at, mut velocity, mut target, mut of_move, mut stop) = (home, 0.0, home, speed, 0);
    for i in 0..count {
        controls.push(at);
        if i < still {
            continue;
        }
        if i + way_back >= count {
            (target, of_move) = (home, speed);
        } else if at == target && velocity == 0.0 {
            if stop > 0 {
                stop -= 1;
                continue;
            }
            target = rng.random_range(lower..=upper);
            of_move = speed * rng.random_range(SLOWEST..=1.0);
            stop = (rng.random_range(0.0..=LONGEST_STOP_S) / h) as usize;
        }
        // the fastest from which it can still stop at the way-point
        let left: f64 = target - at;
        let slowing = acceleration * h;
        let braking = (0.25 * slowing * slowing + 2.0 * acceleration * left.abs()).sqrt() - 0.5 * slowing;
        let wanted = left.signum() * braking.min(left.abs() / h).min(of_move);
        let next = wanted.clamp(velocity - slowing, velocity + slowing);
        let arrives = next == wanted && next.abs() * h >= left.abs();
        velocity = if arrives && left == 0.0 { 0.0 } else { next };
        at = if arrives { target } else { at + velocity * h };
    }
    controls
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::Degree;
    use calibrant_core::simulate::{Purpose, stream};

    #[test]
    fn what_cannot_move_stays() {
        let knots = UniformKnots::covering(0.0, 10.0, 0.2, Degree::Quintic);
        let free = WalkLimits { lower: -1.0, upper: 3.0, speed: 1.0, acceleration: 5.0 };
        for limits in [
            WalkLimits { lower: 3.0, ..free },
            WalkLimits { speed: 0.0, ..free },
            WalkLimits { acceleration: 0.0, ..free },
        ] {
            let controls = walk(&limits, knots, 1.0, &mut stream(1, Purpose::Motion, 0));
            assert!(controls.iter().all(|c| *c == 0.5 * (limits.lower + limits.upper)), "{limits:?}");
        }
    }

    #[test]
    fn it_keeps_its_limits_and_comes_home() {
        let knots = UniformKnots::covering(0.0, 60.0, 0.2, Degree::Quintic);
        for (seed, limits) in [
            WalkLimits { lower: -2.0, upper: 2.0, speed: 2.5, acceleration: 5.0 },
            WalkLimits { lower: -0.4, upper: 0.5, speed: 1.0, acceleration: 5.0 },
            WalkLimits { lower: -6.3, upper: 6.3, speed: 7.0, acceleration: 20.0 },
            WalkLimits { lower: -3.0, upper: 3.0, speed: 10.0, acceleration: 40.0 },
        ]
        .into_iter()
        .enumerate()
        {
            let controls = walk(&limits, knots, 1.0, &mut stream(seed as u64, Purpose::Motion, 0));
            let h = knots.step_s;
            let home = 0.5 * (limits.lower + limits.upper);
            let n = controls.len();
            assert_eq!(n, knots.controls());
            // at rest for 1 s: five intervals of six control points
            assert!(controls[..10].iter().chain(&controls[n - 10..]).all(|c| *c == home), "{limits:?}");
            let velocity: Vec<f64> = controls.windows(2).map(|pair| (pair[1] - pair[0]) / h).collect();
            let most = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            let acceleration: Vec<f64> = velocity.windows(2).map(|pair| (pair[1] - pair[0]) / h).collect();
            assert!(most(&velocity) <= limits.speed * (1.0 + 1e-9), "{limits:?}");
            assert!(most(&acceleration) <= limits.acceleration * (1.0 + 1e-9), "{limits:?}");
            assert!(most(&velocity) > 0.5 * limits.speed, "{limits:?}: it moves");
            let beyond = 0.125 * limits.acceleration * h * h;
            assert!(controls.iter().all(|c| (limits.lower - beyond..=limits.upper + beyond).contains(c)));
        }
    }
}
