//! The joints of a machine.

use super::output::Output;
use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::files::MeshMissing;
use calibrant::error::{Error, InputError, Refusal};
use calibrant::inspection::chain_sheet;
use calibrant::io::{MachineFile, MissingMesh, Urdf, to_json};
use std::path::{Path, PathBuf};

/// What to show of a machine.
#[derive(clap::Args)]
pub(super) struct Options {
    /// Link of a machine that does not move [default: the first].
    #[arg(long, value_name = "LINK")]
    base: Option<String>,
    /// Link of a machine that carries the sensor [default: the last, if there is one].
    #[arg(long, value_name = "LINK")]
    tip: Option<String>,
    /// Directory in which the packages of a machine's meshes lie; looks for the meshes. May be repeated.
    #[arg(long, value_name = "DIR")]
    packages: Vec<PathBuf>,
}

/// Whether a file is named like one of a machine.
pub(super) fn is_machine(file: &Path) -> bool {
    let ends = |end: &str| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(end));
    ["urdf", "xacro", "xml"].into_iter().any(ends)
}

impl Options {
    /// Refuses options of a machine for a recording.
    pub(super) fn refuse_for_recording(&self) -> calibrant::Result<()> {
        if self.base.is_none() && self.tip.is_none() && self.packages.is_empty() {
            return Ok(());
        }
        let message = "--base, --tip and --packages are for machines";
        let help = "give a file whose name ends in .urdf, or leave them away";
        Err(Error::experiment(InputError::new(Refusal::OptionsContradict, message, help)))
    }

    /// Prints the joints between base and tip.
    pub(super) fn inspect(&self, file: &Path, output: &Output) -> calibrant::Result<Exit> {
        let machine = Urdf::read(file)?;
        let chain = machine.chain(self.base.as_deref(), self.tip.as_deref())?;
        let meshes =
            if self.packages.is_empty() { Vec::new() } else { machine.missing_meshes(&self.packages) };
        meshes.iter().for_each(|mesh: &MissingMesh| tell(MeshMissing { mesh: Phrase(mesh.to_string()) }));
        let found = MachineFile { machine: &machine, chain: &chain, meshes: &meshes };
        output.show(|| to_json(&found), &chain_sheet(&machine, &chain, &file.display().to_string()))?;
        Ok(Exit::DONE)
    }
}
