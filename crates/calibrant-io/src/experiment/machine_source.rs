//! Which machine carries the sensor: one that is built in, or a URDF file.

use super::refused_key::refused;
use super::similar_word::nearest;
use crate::machine::{MACHINE_PRESETS, Urdf, machine_preset};
use calibrant_core::error::Result;
use calibrant_machine::chain::KinematicChain;
use std::path::{Path, PathBuf};

/// A machine, and the links between which its joints count.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MachineSource {
    /// The name of a machine that is built in, or the path of a URDF file.
    pub urdf: UrdfSource,
    /// Link that does not move; by default the first.
    pub base: Option<String>,
    /// Link that carries the sensor; by default the last, if there is one.
    pub tip: Option<String>,
    /// Directories in which the packages of its meshes lie.
    pub packages: Vec<PathBuf>,
}

/// Where the text of a machine lies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum UrdfSource {
    /// It is built in.
    Preset(&'static str),
    /// In a file.
    File(PathBuf),
}

impl MachineSource {
    /// Reads the joints between base and tip.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) as [`Urdf::read`] and [`Urdf::chain`].
    pub fn chain(&self) -> Result<KinematicChain> {
        let machine = match &self.urdf {
            UrdfSource::Preset(name) => Urdf::parse(machine_preset(name).unwrap_or_default().as_bytes())?,
            UrdfSource::File(path) => Urdf::read(path)?,
        };
        machine.chain(self.base.as_deref(), self.tip.as_deref())
    }
}

impl UrdfSource {
    /// A name that is built in; else a path, which has an ending, relative to this directory.
    pub(super) fn named(text: &str, directory: Option<&Path>) -> Result<Self> {
        let names = || MACHINE_PRESETS.iter().map(|(name, _)| *name);
        if let Some(preset) = names().find(|name| *name == text) {
            return Ok(Self::Preset(preset));
        }
        if !text.contains(['.', '/', '\\']) {
            let hint =
                nearest(text, names()).map_or(String::new(), |name| format!("did you mean \"{name}\"? "));
            let all = names().collect::<Vec<_>>().join(", ");
            let help = format!("{hint}the path of a URDF file, or one of {all}");
            return Err(refused("machine.urdf", format!("no machine \"{text}\" is built in"), help));
        }
        let path = PathBuf::from(text);
        Ok(Self::File(directory.map_or_else(|| path.clone(), |directory| directory.join(&path))))
    }
}
