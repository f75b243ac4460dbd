//! Which bodies can meet.

use super::{Body, Scene};
use calibrant_machine::chain::KinematicChain;
use nalgebra::Isometry3;
use serde::Serialize;

/// Two links two joints apart that no sampled posture parts by more than this are taken for neighbours. Capsules are up to so much wider than the links of an arm:
/// on a UR5e, base and upper arm overlap by 41 mm in some postures, though the links never touch.
pub(super) const NEVER_APART_M: f64 = 0.055;
/// Sampled postures. The gap of links two joints apart depends on two joints: so many see each by steps of a fiftieth of its range.
const POSTURES: usize = 2500;
/// Irrational numbers whose multiples fill the unit square evenly (Roberts' sequence in the plane).
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];

/// Two bodies that are not kept apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LeftOutPair {
    /// Their names.
    pub bodies: [String; 2],
    /// Why.
    pub reason: Reason,
}

/// Why two bodies are not kept apart.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// One joint is between them.
    Neighbours,
    /// Their capsules are never apart by 55 mm in any sampled posture.
    NeverApart {
        /// The largest gap that was seen, m. Negative: the capsules overlap in all postures.
        largest_gap_m: f64,
    },
    /// An SRDF file disables the pair.
    Disabled,
}

/// Places of two bodies that can meet, the one nearer to the base first.
pub(super) type Pair = (usize, usize);

/// The pairs that can meet, and those that are left out. Bodies of one frame do not move against each other, and are neither.
pub(super) fn pairs(
    chain: &KinematicChain,
    ranges: &[(f64, f64)],
    scene: &Scene,
) -> (Vec<Pair>, Vec<LeftOutPair>) {
    let bodies = &scene.bodies;
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    for i in 0..bodies.len() {
        for j in (0..bodies.len()).filter(|&j| bodies[i].frame < bodies[j].frame) {
            let (one, other) = (&bodies[i], &bodies[j]);
            let of = |pair: &[String; 2]| {
                let is = |a: &str, b: &str| pair[0] == a && pair[1] == b;
                is(&one.name, &other.name) || is(&other.name, &one.name)
            };
            let reason = match other.frame - one.frame {
                1 => Some(Reason::Neighbours),
                _ if scene.disabled.iter().any(of) => Some(Reason::Disabled),
                2 => {
                    let largest_gap_m = largest_gap_m(chain, ranges, one, other);
                    (largest_gap_m < NEVER_APART_M).then_some(Reason::NeverApart { largest_gap_m })
                }
                _ => None,
            };
            match reason {
                None => kept.push((i, j)),
                Some(reason) => {
                    left_out.push(LeftOutPair { bodies: [one.name.clone(), other.name.clone()], reason });
                }
            }
        }
    }
    (kept, left_out)
}

/// The largest distance of two bodies two joints apart in the sampled postures, m.
fn largest_gap_m(chain: &KinematicChain, ranges: &[(f64, f64)], one: &Body, other: &Body) -> f64 {
    let joints = &chain.joints[one.frame..other.frame];
    let gap = |k: usize| {
        let moved = joints.iter().zip(&ranges[one.frame..]).zip(STEPS).fold(
            Isometry3::identity(),
            |frame, ((joint, (low, high)), step)| {
                let position = low + (high - low) * (k as f64 * step).fract();
                let along = joint.axis.into_inner() * position;
                let motion = if joint.kind.turns() {
                    Isometry3::rotation(along)
                } else {
                    Isometry3::translation(along.x, along.y, along.z)
                };
                frame * joint.origin * motion
            },
        );
        let placed = other.capsules.iter().map(|capsule| capsule.placed(&moved));
        let distances =
            placed.flat_map(|far| one.capsules.iter().map(move |near| near.to_capsule(&far).distance_m));
        distances.fold(f64::MAX, f64::min)
    };
    (0..POSTURES).map(gap).fold(f64::MIN, f64::max)
}
