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

    /// The name of a recording is taken by another one. The folder of its results has another name.
    FolderNameTaken "folder-name-taken" Note {
        /// The folder.
        folder: Phrase,
        /// The recording.
        recording: Phrase,
    }
    decided "Names of files without their endings are compared; where two are equal, the parts of the paths that differ."
    says format!("{} is {}: the name is taken", folder.0, recording.0);

    /// Results of an earlier run are kept, since nothing has changed.
    ResultsKept "results-kept" Note {
        /// Recordings that were calibrated before.
        kept: usize,
        /// All recordings.
        recordings: usize,
    }
    decided "Option `resume` is given, and the hashes of files and options are those of the earlier run."
    says format!("{kept} of {recordings} recordings were calibrated before");

    /// What an earlier run kept of a recording cannot be read. The recording is calibrated again.
    ResumeDamaged "resume-damaged" Note {
        /// The file.
        file: Phrase,
    }
    decided "Option `resume` is given, and a resume.json is cut short, or of another version."
    remedy "Nothing: the file is written anew."
    says format!("{} cannot be read: the recording is calibrated again", file.0);

    /// A mesh of a machine is missing.
    MeshMissing "mesh-missing" Warning {
        /// The mesh.
        mesh: Phrase,
    }
    decided "The description of the machine names it, and no file is there."
    remedy "Give the folder of its package."
    says mesh.0.as_str();
}
