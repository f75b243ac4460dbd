//! The bodies of a machine.

use super::Capsule;
use calibrant_machine::chain::KinematicChain;
use nalgebra::Vector3;
use serde::Serialize;

/// Radius of a link whose shape is not known, as a share of the machine's length. The capsules around the meshes of a UR5e and an FR3 have 5 to 11 % of it.
const RADIUS_SHARE: f64 = 0.08;

/// What the capsules of a body are from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BodySource {
    /// They are given.
    Given,
    /// They contain the meshes of the link.
    Mesh,
    /// They contain its boxes, cylinders and spheres.
    Primitive,
    /// They join the joints: no shape of the link is known.
    Joints,
}

/// A rigid body: a link, or the sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name of the link, or `sensor`.
    pub name: String,
    /// The frame that it moves with: 0 the base, k the one behind joint k.
    pub frame: usize,
    /// What it consists of, in the axes of that frame.
    pub capsules: Vec<Capsule>,
    /// What they are from.
    pub source: BodySource,
}

/// Bodies of a machine of which only the joints are known: each link is a capsule from its joint to the next, whose radius is 8 % of the machine's length.
///
/// The machine may be wider. Whoever takes these bodies should be told.
#[must_use]
pub fn bodies_of_joints(chain: &KinematicChain) -> Vec<Body> {
    let ends: Vec<Vector3<f64>> = chain
        .joints
        .iter()
        .map(|joint| joint.origin.translation.vector)
        .chain([chain.tip_transform.translation.vector])
        .collect();
    let radius_m = RADIUS_SHARE * ends.iter().map(Vector3::norm).sum::<f64>();
    let name = |frame: usize| match frame.checked_sub(1) {
        None => chain.base.clone(),
        Some(joint) => format!("behind {}", chain.joints[joint].name),
    };
    let body = |(frame, end): (usize, &Vector3<f64>)| Body {
        name: name(frame),
        frame,
        capsules: vec![Capsule { ends_m: [Vector3::zeros(), *end], radius_m }],
        source: BodySource::Joints,
    };
    ends.iter().enumerate().map(body).collect()
}
