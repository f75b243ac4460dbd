//! Which machine carries the sensor: one that is built in, or a URDF file.

use crate::machine::{MACHINE_PRESETS, Urdf, machine_preset};
use calibrant_core::error::Result;
use calibrant_recording::text::similar_word::nearest;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The name of a machine that is built in.
// a name of its own, since the text of the file cannot be borrowed for it
type PresetName = &'static str;

/// Where the text of a machine lies: a name that is built in, or a path, which has an ending.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum UrdfSource {
    /// It is built in.
    Preset(PresetName),
    /// In a file.
    File(PathBuf),
}

impl UrdfSource {
    /// Reads the machine.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) as [`Urdf::read`].
    pub fn read(&self) -> Result<Urdf> {
        match self {
            Self::Preset(name) => Urdf::parse(machine_preset(name).unwrap_or_default().as_bytes()),
            Self::File(path) => Urdf::read(path),
        }
    }
}

impl From<UrdfSource> for String {
    fn from(source: UrdfSource) -> Self {
        match source {
            UrdfSource::Preset(name) => name.to_owned(),
            UrdfSource::File(path) => path.display().to_string(),
        }
    }
}

impl TryFrom<String> for UrdfSource {
    type Error = String;

    fn try_from(text: String) -> std::result::Result<Self, String> {
        let names = || MACHINE_PRESETS.iter().map(|(name, _)| *name);
        if let Some(preset) = names().find(|name| *name == text) {
            return Ok(Self::Preset(preset));
        }
        if text.contains(['.', '/', '\\']) {
            return Ok(Self::File(text.into()));
        }
        let hint = nearest(&text, names()).map_or(String::new(), |name| format!("did you mean \"{name}\"? "));
        let all = names().collect::<Vec<_>>().join(", ");
        Err(format!("no machine \"{text}\" is built in\n{hint}the path of a URDF file, or one of {all}"))
    }
}
