//! What `inspect` says of a machine, as JSON.

use super::{MissingMesh, Urdf};
use crate::results::heading::{Heading, JsonFile};
use calibrant_core::json::flat;
use calibrant_core::json_object;
use calibrant_machine::chain::{Joint, JointKind, KinematicChain, reach_m};

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

/// A machine, a chain of it, and the meshes that were not found.
#[derive(Clone, Copy)]
pub struct MachineFile<'a> {
    /// The machine.
    pub machine: &'a Urdf,
    /// The chain.
    pub chain: &'a KinematicChain,
    /// Meshes that were not found.
    pub meshes: &'a [MissingMesh],
}

json_object! {
    /// A machine and a chain of it.
    MachineFile<'_> as of {
        heading: flat(Heading::<Self>::of()),
        /// The name of the machine.
        machine: &of.machine.name,
        /// The names of its links.
        links: of.machine.links().collect::<Vec<_>>(),
        /// The link that stands still.
        base: &of.chain.base,
        /// The link that carries the sensor.
        tip: &of.chain.tip,
        reach_m: reach_m(of.chain),
        /// The joints between them, from the base.
        joints: of.chain.joints.iter().map(JointOf).collect::<Vec<_>>(),
        /// Files of shapes that are not there.
        missing_meshes: of.meshes.iter().map(MeshOf).collect::<Vec<_>>(),
    }
}

impl JsonFile for MachineFile<'_> {
    const KIND: &'static str = "chain";
}

struct JointOf<'a>(&'a Joint);

json_object! {
    JointOf<'_> as joint {
        /// Its name.
        name: &joint.0.name,
        /// Does it turn or slide, and within limits?
        kind: joint.0.kind.name(),
        /// Of its position; its velocity is per second, its effort in N·m or N.
        unit: joint.0.kind.unit(),
        /// Its lower limit, in rad or m.
        lower: joint.0.limits.lower,
        /// Its upper limit, in rad or m.
        upper: joint.0.limits.upper,
        /// Its largest velocity, in rad/s or m/s.
        velocity: joint.0.limits.velocity,
        /// Its largest effort, in N·m or N.
        effort: joint.0.limits.effort,
        /// Limits that it should have and its file does not say.
        missing: missing_limits(joint.0),
    }
}

struct MeshOf<'a>(&'a MissingMesh);

json_object! {
    MeshOf<'_> as of {
        /// The link that it is of.
        link: &of.0.link,
        /// The file.
        mesh: &of.0.mesh,
    }
}
