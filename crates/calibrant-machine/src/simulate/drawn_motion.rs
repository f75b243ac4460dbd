//! Motions at random: of the joints of a chain, or of a body in the hand.
//!
//! One coordinate that goes from way-point to way-point within its limits.
//!
//! The control points of a uniform B-spline bound it: the value lies in their hull, the velocity in that of their differences, and so on. So what holds for
//! control points holds at any time.

use crate::chain::{Joint, KinematicChain};
use crate::reference::{JointMotion, Motion, PoseMotion};
use crate::spline::{Degree, RotationSpline, UniformKnots, VectorSpline};
use calibrant_core::simulate::Rng;
use nalgebra::{UnitQuaternion, Vector3};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// Distance of the knots, s: the motion has frequencies up to about 1.5 Hz.
const KNOT_STEP_S: f64 = 0.2;
/// A joint that turns goes at most this far to either side of the middle of its range, rad.
const TURN_RAD: f64 = 2.2;
/// A joint without limits goes this far to either side: two full turns, rad.
const ENDLESS_RAD: f64 = TAU;
/// A slide without limits goes this far to either side, m.
const ENDLESS_M: f64 = 0.5;
/// Part of the range and of the speed that is used.
const USED: f64 = 0.9;
/// Speed of a joint whose machine states none, rad/s and m/s.
const SPEED: [f64; 2] = [2.0, 0.5];
/// A hand moves a body this far along each axis, m, with this speed, m/s.
const HAND: (f64, f64) = (0.5, 1.0);
/// A hand turns a body about each of its axes with this rate, rad/s, this change of it, rad/s², and this change of that, rad/s³.
const TURNED_BY_HAND: (f64, f64, f64) = (3.0, 10.0, 40.0);
/// Height at which it is held, m.
const HEIGHT_M: f64 = 1.2;

/// A motion to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionToDraw {
    /// Duration, s. It begins at 0.
    pub duration_s: f64,
    /// At rest for so long at the beginning and at the end, s.
    pub rest_s: f64,
    /// Largest acceleration of each coordinate, rad/s² or m/s².
    pub acceleration: f64,
    /// Distance of the way-points of cubic splines, s, where the machine has such; otherwise quintic splines.
    pub knot_step_s: Option<f64>,
}

impl MotionToDraw {
    fn knots(&self) -> UniformKnots {
        let (step_s, degree) =
            self.knot_step_s.map_or((KNOT_STEP_S, Degree::Quintic), |step_s| (step_s, Degree::Cubic));
        UniformKnots::covering(0.0, self.duration_s, step_s, degree)
    }
}

/// A motion of the joints within their limits. Each goes from way-point to way-point by itself, so the links may pass through each other: it is for
/// simulations, not for an arm.
///
/// # Examples
/// ```
/// use calibrant_core::simulate::{Purpose, stream};
/// use calibrant_machine::chain::*;
/// use calibrant_machine::reference::Motion;
/// use calibrant_machine::simulate::{MotionToDraw, draw_joint_motion};
/// use nalgebra::{Isometry3, Vector3};
/// let slide = Joint {
///     name: "slide".into(),
///     kind: JointKind::Prismatic,
///     axis: Vector3::x_axis(),
///     origin: Isometry3::identity(),
///     limits: JointLimits { lower: Some(-0.5), upper: Some(0.5), velocity: Some(1.0), ..JointLimits::default() },
/// };
/// let (base, tip) = ("base".into(), "carriage".into());
/// let chain = KinematicChain { base, tip, joints: vec![slide], tip_transform: Isometry3::identity() };
/// let wanted = MotionToDraw { duration_s: 20.0, rest_s: 1.0, acceleration: 5.0, knot_step_s: None };
/// let motion = draw_joint_motion(&chain, &wanted, &mut stream(1, Purpose::Motion, 0));
/// let Motion::Joints(motion) = motion else { panic!("of joints") };
/// assert!(motion.positions.controls.iter().all(|position| position.abs() <= 0.5));
/// ```
#[must_use]
pub fn draw_joint_motion(chain: &KinematicChain, wanted: &MotionToDraw, rng: &mut Rng) -> Motion {
    let knots = wanted.knots();
    let limits = chain.joints.iter().map(|joint| limits_of(joint, wanted.acceleration, knots.step_s));
    let positions = vector_spline(limits, knots, wanted.rest_s, rng);
    Motion::Joints(JointMotion { chain: chain.clone(), positions })
}

/// A motion by hand: about half a metre to all sides, and through all orientations.
#[must_use]
pub fn draw_body_motion(wanted: &MotionToDraw, rng: &mut Rng) -> Motion {
    let knots = wanted.knots();
    let (reach_m, speed) = HAND;
    let along = |middle: f64| WalkLimits {
        lower: middle - reach_m,
        upper: middle + reach_m,
        speed,
        acceleration: wanted.acceleration,
    };
    let position = vector_spline([0.0, 0.0, HEIGHT_M].map(along).into_iter(), knots, wanted.rest_s, rng);
    let (rate, speed, acceleration) = TURNED_BY_HAND;
    let about = WalkLimits { lower: -rate, upper: rate, speed, acceleration };
    let rates = vector_spline([about; 3].into_iter(), knots, wanted.rest_s, rng);
    let mut orientation = any_rotation(rng);
    let turned = |rate: &[f64]| {
        let now = orientation;
        orientation *= UnitQuaternion::from_scaled_axis(Vector3::from_column_slice(rate) * knots.step_s);
        now
    };
    let controls = rates.controls.chunks_exact(3).map(turned).collect();
    Motion::Poses(PoseMotion { position, orientation: RotationSpline { knots, controls } })
}

/// A rotation of which none is more likely than another.
pub(super) fn any_rotation(rng: &mut Rng) -> UnitQuaternion<f64> {
    let [w, x, y, z]: [f64; 4] = std::array::from_fn(|_| StandardNormal.sample(rng));
    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z))
}

fn vector_spline(
    limits: impl Iterator<Item = WalkLimits>,
    knots: UniformKnots,
    rest_s: f64,
    rng: &mut Rng,
) -> VectorSpline {
    let walks: Vec<Vec<f64>> = limits.map(|limits| walk(&limits, knots, rest_s, rng)).collect();
    let controls = (0..knots.controls()).flat_map(|i| walks.iter().map(move |walk| walk[i])).collect();
    VectorSpline { knots, dimension: walks.len(), controls }
}

fn limits_of(joint: &Joint, acceleration: f64, step_s: f64) -> WalkLimits {
    let turns = joint.kind.turns();
    let (middle, half) = match joint.limits.lower.zip(joint.limits.upper) {
        Some((lower, upper)) => {
            let half = 0.5 * USED * (upper - lower);
            (0.5 * (lower + upper), if turns { half.min(TURN_RAD) } else { half })
        }
        None => (0.0, if turns { ENDLESS_RAD } else { ENDLESS_M }),
    };
    let speed = joint.limits.velocity.map_or(SPEED[usize::from(!turns)], |velocity| USED * velocity);
    // a joint with a short way cannot use all of its acceleration: it would pass its way-points
    let acceleration = acceleration.min(0.25 * half / (step_s * step_s));
    WalkLimits { lower: middle - half, upper: middle + half, speed, acceleration }
}

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
