//! What a machine may meet: itself, the floor, boxes; distances with the points at which they are taken.
//!
//! Each link is one capsule or several: all points within `r` of a segment. The sensor's body is a ball on the tip. Two capsules are apart by the
//! distance of their segments less both radii. So a distance is smooth where the nearest points are single, and its gradient needs these points only:
//! a joint moves the point `x` behind it by `u × (x − o)` or by `u`, and the distance by the normal times that.
//!
//! # Why our own distances
//! `parry3d-f64` 0.31 was tried. It needs 49 s of processor time to build and 37 crates, its vectors are those of glam rather than nalgebra, and
//! capsule against box is iterated (GJK, then EPA where they overlap). Capsules need two closed forms, segment to segment and
//! segment to box: a page each, exact to rounding inside and outside, and the same bits on every machine.
//! Convex hulls would come nearer to the machine than capsules. But their nearest points jump between vertices, so an interior point stumbles over them,
//! and `parry3d` would not change that.
//!
//! # Which pairs can meet
//! Links that one joint joins touch always. Links two joints apart are left out if no sampled posture parts their capsules by
//! 55 mm: there the capsules are wider than the links, and the machine's own shape decides. This is sampled, not proved, and
//! [`World::left_out`] names each such pair with the gap that was seen. Pairs that an SRDF file disables are left out, too. All others are rows.

mod body;
mod capsule;
mod cuboid;
mod fit;
mod pairs;
mod proximity;
mod scene;
mod segment;
#[cfg(test)]
mod tests;

pub use body::{Body, BodySource, bodies_of_joints};
pub use capsule::Capsule;
pub use cuboid::Cuboid;
pub use fit::{Shape, capsule_around};
pub use pairs::{LeftOutPair, Reason};
pub use proximity::{BodyPair, FAR_M, Proximity, World};
pub use scene::Scene;
