//! The joints of a machine.

use crate::console;
use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::files::MeshMissing;
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{MachineFile, MissingMesh, Urdf, missing_limits, to_json};
use calibrant::machine::chain::{Joint, JointKind, KinematicChain, reach_m};
use calibrant::report::number_format::{counted, short, significant};
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
    pub(super) fn inspect(&self, file: &Path, json: bool) -> calibrant::Result<Exit> {
        let machine = Urdf::read(file)?;
        let chain = machine.chain(self.base.as_deref(), self.tip.as_deref())?;
        let meshes =
            if self.packages.is_empty() { Vec::new() } else { machine.missing_meshes(&self.packages) };
        meshes.iter().for_each(|mesh: &MissingMesh| tell(MeshMissing { mesh: Phrase(mesh.to_string()) }));
        let found = MachineFile { machine: &machine, chain: &chain, meshes: &meshes };
        console::json_or(json, || to_json(&found), || text(file, &machine, &chain));
        Ok(Exit::DONE)
    }
}

fn text(file: &Path, machine: &Urdf, chain: &KinematicChain) -> String {
    let mut text = format!(
        "{}: machine {}, {}\n  from {} to {}: {}{}\n\n",
        file.display(),
        machine.name,
        counted(machine.links().count(), "link"),
        chain.base,
        chain.tip,
        counted(chain.joints.len(), "joint"),
        match reach_m(chain) {
            Some(reach) => format!(", reach {} m", significant(reach, 3)),
            None => String::new(),
        }
    );
    if chain.joints.is_empty() {
        return text + "No joint moves between them.\n";
    }
    let rows: Vec<_> = chain.joints.iter().map(row).collect();
    text.push_str(&console::table(&["joint", "kind", "position", "velocity", "effort"], &rows));
    for joint in &chain.joints {
        let missing = missing_limits(joint);
        if !missing.is_empty() {
            text.push_str(&format!("  joint {}: no limit of {}\n", joint.name, missing.join(", ")));
        }
    }
    text + "  URDF has no limits of acceleration and jerk.\n"
}

fn row(joint: &Joint) -> Vec<String> {
    let unit = joint.kind.unit();
    let effort_unit = if joint.kind.turns() { "N·m" } else { "N" };
    let or_dash = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), short);
    let with_unit = |value: Option<f64>, unit: &str| {
        value.map_or_else(|| "–".to_owned(), |value| format!("{} {unit}", short(value)))
    };
    let limits = &joint.limits;
    let position = match joint.kind {
        JointKind::Continuous => "any".to_owned(),
        _ => format!("{} to {} {unit}", or_dash(limits.lower), or_dash(limits.upper)),
    };
    vec![
        joint.name.clone(),
        joint.kind.name().to_owned(),
        position,
        with_unit(limits.velocity, &format!("{unit}/s")),
        with_unit(limits.effort, effort_unit),
    ]
}
