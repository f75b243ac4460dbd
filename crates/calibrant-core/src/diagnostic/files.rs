//! Checks of the files around a result.

use super::check::checks;
use super::parts::Phrase;

checks! {
    /// A result of an earlier run stays in the folder.
    ResultLeftOver "result-left-over" Warning {
        /// The file.
        file: Phrase,
    }
    decided "The command can write this file, and has not."
    remedy "Remove it, or choose another folder."
    says format!("{} is that of an earlier run", file.0);

    /// A mesh of a machine is missing.
    MeshMissing "mesh-missing" Warning {
        /// The mesh.
        mesh: Phrase,
    }
    decided "The description of the machine names it, and no file is there."
    remedy "Give the folder of its package."
    says mesh.0.as_str();
}
