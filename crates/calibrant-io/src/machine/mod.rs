//! The machine that carries the sensor: URDF files and presets.
//!
//! URDF is read by a small reader of our own on an XML tree with positions. A deserialised file no longer knows where its elements stand,
//! and an error should say the line and the element.

mod element;
mod inspection;
mod joint;
mod link_tree;
mod meshes;
mod presets;
mod urdf;

pub use inspection::{MachineFile, missing_limits};
pub use meshes::MissingMesh;
pub use presets::{MACHINE_PRESETS, machine_preset};
pub use urdf::Urdf;
