//! The order of dependence between modules: data flow one way.

use std::path::{Path, PathBuf};

/// What each module may use.
const MAY_USE: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("arrowhead", &[]),
    ("root", &[]),
    ("sensor", &["error"]),
    ("motion", &["error", "sensor"]),
    ("information", &["error", "sensor", "motion", "arrowhead"]),
    ("estimate", &["error", "sensor", "motion", "arrowhead", "root", "information"]),
    ("noise", &["error", "sensor", "motion", "root"]),
    ("simulate", &["error", "sensor", "motion", "noise"]),
    ("design", &["error", "sensor", "motion", "arrowhead", "information", "simulate"]),
    ("study", &["error", "sensor", "motion", "information", "simulate", "estimate", "design"]),
    ("io", &["error", "sensor", "motion", "information", "noise", "simulate", "estimate", "design", "study"]),
    (
        "report",
        &["error", "sensor", "motion", "information", "noise", "simulate", "estimate", "design", "study"],
    ),
];

fn sources(directory: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in
        std::fs::read_dir(directory).expect("a directory").map(|entry| entry.expect("readable").path())
    {
        if entry.is_dir() {
            found.extend(sources(&entry));
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            found.push(entry);
        }
    }
    found
}

/// Modules named in `crate::name` outside comments and outside test modules.
fn uses(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
        .collect()
}

#[test]
fn no_module_uses_one_above_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen = 0;
    for path in sources(&root) {
        let inside = path.strip_prefix(&root).expect("inside").to_string_lossy().replace('\\', "/");
        let module = inside.split(['/', '.']).next().unwrap_or_default().to_owned();
        if module == "lib" || inside.ends_with("tests.rs") {
            continue;
        }
        let (_, allowed) = MAY_USE
            .iter()
            .find(|(name, _)| *name == module)
            .unwrap_or_else(|| panic!("{module}: say what it may use"));
        for used in uses(&std::fs::read_to_string(&path).expect("readable")) {
            let root_item = used == "Result" || used == "Error";
            assert!(root_item || used == module || allowed.contains(&used.as_str()), "{inside} uses {used}");
            seen += 1;
        }
    }
    assert!(seen > 50, "the test reads the sources");
}

#[test]
fn files_hold_one_idea() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for path in sources(&root) {
        let lines = std::fs::read_to_string(&path).expect("readable").lines().count();
        assert!(lines <= 500, "{} has {lines} lines: split it", path.display());
    }
}
