//! What `inspect` says of a machine, as JSON.

use super::{MissingMesh, Urdf};
use crate::json;
use calibrant_machine::chain::{Joint, JointKind, KinematicChain, reach_m};
use serde::Serialize;

/// The limits that a joint should have and its file does not say, in words.
///
/// # Examples
/// ```
/// use calibrant_io::{Urdf, machine_preset, missing_limits};
/// let text = machine_preset("rate-table").expect("known").replace(r#"effort="10""#, "");
/// let chain = Urdf::parse(text.as_bytes())?.chain(None, None)?;
/// assert_eq!(missing_limits(&chain.joints[0]), ["effort"]);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[must_use]
pub fn missing_limits(joint: &Joint) -> Vec<&'static str> {
    let limits = &joint.limits;
    let bounded = joint.kind != JointKind::Continuous;
    let all = [
        ("lower", bounded && limits.lower.is_none()),
        ("upper", bounded && limits.upper.is_none()),
        ("velocity", limits.velocity.is_none()),
        ("effort", limits.effort.is_none()),
    ];
    all.into_iter().filter_map(|(name, missing)| missing.then_some(name)).collect()
}

/// A machine, a chain of it, and the meshes that were not found, as JSON.
#[must_use]
pub fn machine_json(machine: &Urdf, chain: &KinematicChain, meshes: &[MissingMesh]) -> String {
    json::to_json(&MachineFile {
        schema: 1,
        machine: &machine.name,
        links: machine.links().collect(),
        base: &chain.base,
        tip: &chain.tip,
        reach_m: reach_m(chain),
        joints: chain.joints.iter().map(JointFields::of).collect(),
        missing_meshes: meshes.iter().map(|one| MeshFields { link: &one.link, mesh: &one.mesh }).collect(),
    })
}

#[derive(Serialize)]
struct MachineFile<'a> {
    schema: u32,
    machine: &'a str,
    links: Vec<&'a str>,
    base: &'a str,
    tip: &'a str,
    reach_m: Option<f64>,
    joints: Vec<JointFields<'a>>,
    missing_meshes: Vec<MeshFields<'a>>,
}

#[derive(Serialize)]
struct JointFields<'a> {
    name: &'a str,
    kind: &'static str,
    /// Of its position; its velocity is per second, its effort in N·m or N.
    unit: &'static str,
    lower: Option<f64>,
    upper: Option<f64>,
    velocity: Option<f64>,
    effort: Option<f64>,
    missing: Vec<&'static str>,
}

impl<'a> JointFields<'a> {
    fn of(joint: &'a Joint) -> Self {
        Self {
            name: &joint.name,
            kind: joint.kind.name(),
            unit: joint.kind.unit(),
            lower: joint.limits.lower,
            upper: joint.limits.upper,
            velocity: joint.limits.velocity,
            effort: joint.limits.effort,
            missing: missing_limits(joint),
        }
    }
}

#[derive(Serialize)]
struct MeshFields<'a> {
    link: &'a str,
    mesh: &'a str,
}
