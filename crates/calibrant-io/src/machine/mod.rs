//! The machine that carries the sensor: URDF files and presets.
//!
//! URDF is read by a small reader of our own on an XML tree with positions. A deserialised file no longer knows where its elements stand,
//! and an error should say the line and the element.

mod collision;
mod element;
mod franka;
mod inspection;
mod joint;
mod joint_limits;
mod link_frames;
mod link_tree;
mod meshes;
mod presets;
mod srdf;
mod stl;
#[cfg(test)]
mod tests;
mod urdf;
mod xml;

pub use collision::{LinkWithoutMesh, MachineBodies};
pub use inspection::{MachineFile, missing_limits};
pub use joint_limits::{FileJointLimits, parse_joint_limits, read_joint_limits};
pub(crate) use joint_limits::{JointLimitsFile, read_joint_limits_file};
pub use link_frames::LinkInChain;
pub use meshes::MissingMesh;
pub use presets::{MACHINE_PRESETS, machine_preset};
pub(crate) use srdf::read_named_srdf;
pub use srdf::{parse_srdf, read_srdf};
pub use stl::parse_stl;
pub use urdf::Urdf;
