//! Which machine carries the sensor: one that is built in, or a URDF file.

use super::known_keys::nearest;
use super::toml_document::{Entry, Section};
use crate::machine::{MACHINE_PRESETS, Urdf, machine_preset};
use calibrant_core::error::Result;
use calibrant_machine::chain::KinematicChain;
use std::path::PathBuf;

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

/// Reads `urdf`, `base`, `tip` and `packages`.
pub(super) fn read_source(section: &Section<'_>) -> Result<Option<MachineSource>> {
    let link = |key: &str| section.get(key).map(|entry| name(&entry)).transpose();
    let (base, tip) = (link("base")?, link("tip")?);
    let Some(entry) = section.get("urdf") else {
        return match ["base", "tip", "packages"].iter().find_map(|key| section.get(key)) {
            Some(entry) => {
                Err(entry.reject("this needs a machine", "urdf = \"arm.urdf\" in [machine], for example"))
            }
            None => Ok(None),
        };
    };
    /// The remedy for wrong directories.
    const PACKAGES: &str = "a list of directories: [\"description\"]";
    let packages = section.get("packages").map_or(Ok(Vec::new()), |entry| {
        entry.items(PACKAGES)?.iter().map(|item| item.path(PACKAGES)).collect::<Result<_>>()
    })?;
    Ok(Some(MachineSource { urdf: urdf(&entry)?, base, tip, packages }))
}

fn name(entry: &Entry<'_>) -> Result<String> {
    /// The remedy for a wrong link.
    const HELP: &str = "the name of a link, in quotes; `calibrant inspect arm.urdf` lists the joints";
    entry.text().map(str::to_owned).ok_or_else(|| entry.wrong_type("a string", HELP))
}

/// A name that is built in; else a path, which has an ending.
fn urdf(entry: &Entry<'_>) -> Result<UrdfSource> {
    let names = || MACHINE_PRESETS.iter().map(|(name, _)| *name);
    let help = format!("the path of a URDF file, or one of {}", names().collect::<Vec<_>>().join(", "));
    let path = entry.path(&help)?;
    let text = entry.text().unwrap_or_default();
    if let Some(preset) = names().find(|name| *name == text) {
        return Ok(UrdfSource::Preset(preset));
    }
    if !text.contains(['.', '/', '\\']) {
        let hint = nearest(text, names()).map_or(String::new(), |name| format!("did you mean \"{name}\"? "));
        return Err(entry.reject(format!("no machine \"{text}\" is built in"), format!("{hint}{help}")));
    }
    Ok(UrdfSource::File(path))
}
