//! Reads the crates of the workspace from the disk, for the architecture test.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A crate: its sources by file name, `calibrant/src/lib.rs`, and the crates it depends on.
pub(crate) struct Crate {
    pub(crate) name: String,
    pub(crate) root: String,
    pub(crate) sources: BTreeMap<String, String>,
    pub(crate) dependencies: BTreeSet<String>,
}

/// All crates under `crates/`.
pub(crate) fn all() -> Vec<Crate> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the folder of the crates");
    let mut crates = Vec::new();
    for path in entries(folder) {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let Ok(manifest) = std::fs::read_to_string(path.join("Cargo.toml")) else { continue };
        let mut sources = BTreeMap::new();
        read_sources(&path.join("src"), folder, &mut sources);
        let root = ["lib.rs", "main.rs"].map(|file| format!("{name}/src/{file}"));
        let root = root.into_iter().find(|file| sources.contains_key(file)).expect("lib.rs or main.rs");
        crates.push(Crate { name, root, sources, dependencies: dependencies(&manifest) });
    }
    assert!(crates.len() > 2, "the test reads the workspace");
    crates
}

fn entries(folder: &Path) -> Vec<std::path::PathBuf> {
    let mut entries: Vec<_> =
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable").path()).collect();
    entries.sort();
    entries
}

fn read_sources(folder: &Path, base: &Path, sources: &mut BTreeMap<String, String>) {
    for path in entries(folder) {
        if path.is_dir() {
            read_sources(&path, base, sources);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(base).expect("inside").to_string_lossy().replace('\\', "/");
            sources.insert(name, std::fs::read_to_string(&path).expect("readable"));
        }
    }
}

/// The names in `[dependencies]`. Dependencies of tests alone do not count.
pub(crate) fn dependencies(manifest: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut inside = false;
    for line in manifest.lines().map(str::trim) {
        if let Some(section) = line.strip_prefix('[') {
            inside = section.starts_with("dependencies]");
            names.extend(
                section.strip_prefix("dependencies.").map(|name| name.trim_end_matches(']').to_owned()),
            );
        } else if inside && !line.starts_with('#') {
            let name = line.split(['.', ' ', '=']).next().unwrap_or_default();
            names.extend((!name.is_empty()).then(|| name.to_owned()));
        }
    }
    names
}
