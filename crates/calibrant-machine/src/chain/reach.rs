//! How far a machine reaches.

use super::{CorrectedChain, Joint, KinematicChain};
use std::f64::consts::{PI, TAU};

/// Number of postures from which the search starts.
const STARTS: usize = 16;
/// A prismatic joint that goes so far has no end, m.
const ENDLESS_M: f64 = 1000.0;
/// Largest number of passes over the joints.
const PASSES: usize = 50;

/// The largest distance of the tip from the base that a search finds within the limits of position, m.
///
/// The squared distance is `A + B cos q + C sin q` in the position of a revolute joint, and convex in that of a prismatic one. So one joint after
/// the other goes to its best position, until the distance no longer grows, from 16 postures. `None` if a prismatic joint has no limits.
///
/// # Examples
/// ```
/// use calibrant_machine::chain::*;
/// use nalgebra::{Isometry3, Vector3};
/// let joint = |name: &str, x: f64| Joint {
///     name: name.into(),
///     kind: JointKind::Revolute,
///     axis: Vector3::z_axis(),
///     origin: Isometry3::translation(x, 0.0, 0.0),
///     limits: JointLimits { lower: Some(-2.0), upper: Some(-1.57079632679), ..JointLimits::default() },
/// };
/// let arm = KinematicChain {
///     base: "base".into(),
///     tip: "hand".into(),
///     joints: vec![joint("shoulder", 0.0), joint("elbow", 0.3)],
///     tip_transform: Isometry3::translation(0.4, 0.0, 0.0),
/// };
/// // the elbow cannot be straight
/// assert!((reach_m(&arm).expect("bounded") - 0.5).abs() < 1e-9);
/// ```
#[must_use]
pub fn reach_m(chain: &KinematicChain) -> Option<f64> {
    let nominal = chain.nominal();
    let ranges: Vec<(f64, f64)> = chain.joints.iter().map(range).collect::<Option<_>>()?;
    let from = |start: usize| {
        // postures without a pattern, by multiples of irrational numbers
        let share = |i: usize| (start as f64 * 0.618_034 + (start * i) as f64 * 0.414_214).fract();
        let mut q: Vec<f64> =
            ranges.iter().enumerate().map(|(i, (low, high))| low + share(i) * (high - low)).collect();
        climb(&nominal, chain, &ranges, &mut q)
    };
    Some((0..STARTS).map(from).fold(0.0, f64::max).sqrt())
}

/// Positions to search; `None` for a prismatic joint without an end.
fn range(joint: &Joint) -> Option<(f64, f64)> {
    let bounds = joint.limits.lower.zip(joint.limits.upper);
    if joint.kind.turns() {
        return Some(bounds.filter(|(lower, upper)| upper - lower < TAU).unwrap_or((-PI, PI)));
    }
    bounds.filter(|(lower, upper)| lower.abs().max(upper.abs()) < ENDLESS_M)
}

/// Squared distance after one joint after the other went to its best position.
fn climb(nominal: &CorrectedChain, chain: &KinematicChain, ranges: &[(f64, f64)], q: &mut [f64]) -> f64 {
    let square = |q: &[f64]| nominal.tip_pose(q).translation.vector.norm_squared();
    let mut best = square(q);
    for _ in 0..PASSES {
        let before = best;
        for (i, (joint, &(lower, upper))) in chain.joints.iter().zip(ranges).enumerate() {
            let mut at = |position: f64| {
                q[i] = position;
                square(q)
            };
            let mut candidates = vec![lower, upper];
            if joint.kind.turns() {
                let [a, b, c] = [0.0, TAU / 3.0, -TAU / 3.0].map(&mut at);
                let peak = (3.0_f64.sqrt() * (b - c)).atan2(2.0 * a - b - c);
                let within = peak + TAU * ((lower - peak) / TAU).ceil();
                candidates.extend((within <= upper).then_some(within));
            }
            let squares = candidates.into_iter().map(|position| (at(position), position));
            let (square, position) =
                squares.fold((f64::MIN, 0.0), |one, other| if other.0 > one.0 { other } else { one });
            (best, q[i]) = (square, position);
        }
        if best <= before * (1.0 + 1e-12) {
            break;
        }
    }
    best
}
