//! The architecture test, on the sources of the workspace: crates and modules in order, no circle of files,
//! small files.

mod crates;
mod graph;
mod made_up;
mod modules;
mod tokens;

use std::collections::BTreeSet;

use crates::Crate;
use graph::Graph;
use modules::Modules;

/// The crates from the lowest layer up; each uses crates of lower layers only.
const LAYERS: &[&[&str]] = &[
    &["calibrant-core"],
    &["calibrant-campaign", "calibrant-design", "calibrant-machine"],
    &["calibrant-machine-design", "calibrant-study"],
    &["calibrant-recording", "calibrant-report"],
    &["calibrant-io"],
    &["calibrant-records"],
    &["calibrant"],
    &["calibrant-guide"],
    &["calibrant-cli"],
    &["calibrant-py"],
];

/// What each module of calibrant-core may use.
const MAY_USE: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("budget", &["error"]),
    ("diagnostic", &["json", "error", "sensor", "motion", "number_format"]),
    ("acceptance", &["form", "json", "diagnostic"]),
    ("arrowhead", &[]),
    ("form", &[]),
    ("fourier", &[]),
    ("json", &[]),
    ("interruption", &["error"]),
    ("number_format", &[]),
    ("progress", &[]),
    ("root", &[]),
    ("sensor", &["form", "json", "error"]),
    ("motion", &["form", "json", "error", "sensor"]),
    ("information", &["json", "error", "sensor", "motion", "arrowhead", "number_format"]),
    ("solve", &["json", "arrowhead", "root"]),
    (
        "estimate",
        &[
            "form",
            "json",
            "diagnostic",
            "error",
            "sensor",
            "motion",
            "arrowhead",
            "root",
            "information",
            "solve",
        ],
    ),
    (
        "noise",
        &[
            "json",
            "diagnostic",
            "error",
            "fourier",
            "interruption",
            "sensor",
            "motion",
            "root",
            "number_format",
        ],
    ),
    ("simulate", &["form", "json", "error", "sensor", "motion", "noise"]),
];

fn workspace() -> (Vec<Crate>, Modules) {
    let crates = crates::all();
    let mut modules = Modules::default();
    for one in &crates {
        modules.read_crate(&one.name, &one.root, &one.sources);
    }
    (crates, modules)
}

#[test]
fn the_graph_knows_all_sources() {
    let (crates, modules) = workspace();
    assert!(modules.without_file.is_empty(), "declared, but without a file: {:#?}", modules.without_file);
    let read = modules.files();
    let of_tests = |file: &str| file.ends_with("tests.rs") || file.contains("/tests/");
    for file in crates.iter().flat_map(|one| one.sources.keys()) {
        assert!(read.contains(file.as_str()) || of_tests(file), "{file} is in no module");
    }
    let graph = Graph::new(&modules);
    assert!(graph.unresolved.is_empty(), "paths to nothing: {:#?}", graph.unresolved);
    let edges: usize = graph.edges.values().map(|used| used.len()).sum();
    assert!(edges > 2 * read.len(), "{edges} uses between {} files", read.len());
}

#[test]
fn no_circle_of_files() {
    let (_, modules) = workspace();
    let graph = Graph::new(&modules);
    let circles: Vec<String> = graph.circles().iter().map(|circle| graph.describe(circle)).collect();
    assert!(circles.is_empty(), "{} circles\n{}", circles.len(), circles.join("\n"));
}

#[test]
fn children_take_nothing_from_their_parent() {
    let (_, modules) = workspace();
    let mut taken = Vec::new();
    for (file, used) in Graph::new(&modules).edges {
        let parents = used.iter().filter(|(other, _)| is_parent(other, &file));
        taken.extend(parents.map(|(other, path)| format!("{file} uses {other} ({path})")));
    }
    assert!(taken.is_empty(), "move these items into files of their own:\n{}", taken.join("\n"));
}

/// Does a file hold the module that contains the other? `a/mod.rs` or `a.rs` does for `a/b.rs`.
fn is_parent(parent: &str, file: &str) -> bool {
    let folder = parent.strip_suffix("mod.rs").map(str::to_owned);
    file != parent && file.starts_with(&folder.unwrap_or_else(|| parent.replace(".rs", "/")))
}

#[test]
fn no_module_uses_one_above_it() {
    let (_, modules) = workspace();
    for (file, used) in Graph::new(&modules).edges {
        let Some(module) = module_of(&file) else { continue };
        let (_, allowed) = MAY_USE
            .iter()
            .find(|(name, _)| *name == module)
            .unwrap_or_else(|| panic!("{module}: say what it may use"));
        for (other, path) in used {
            let Some(other) = module_of(&other) else { panic!("{file} uses {other} ({path})") };
            assert!(other == module || allowed.contains(&other), "{file} uses {other} ({path})");
        }
    }
}

/// The module of calibrant-core that a file belongs to.
fn module_of(file: &str) -> Option<&str> {
    let inside = file.strip_prefix("calibrant-core/src/")?;
    inside.split(['/', '.']).next().filter(|module| *module != "lib")
}

#[test]
fn no_crate_uses_one_above_it() {
    let layer = |name: &str| LAYERS.iter().position(|layer| layer.contains(&name));
    let crates = crates::all();
    let names: BTreeSet<&str> = crates.iter().map(|one| one.name.as_str()).collect();
    for one in &crates {
        let own = layer(&one.name).unwrap_or_else(|| panic!("{}: say its layer", one.name));
        for used in one.dependencies.iter().filter(|used| names.contains(used.as_str())) {
            assert!(layer(used).is_some_and(|used| used < own), "{} uses {used}", one.name);
        }
    }
    assert!(crates.iter().any(|one| one.name == "calibrant-cli" && one.dependencies.contains("calibrant")));
}

/// Options are data: each surface words them. The exceptions are flags of other programs, and a command.
#[test]
fn no_message_of_the_library_names_a_flag() {
    const OF_OTHERS: [&str; 5] = [
        "rosbags-convert --src",
        "mcap compress --",
        "Kalibr with --imu-models",
        "`calibrate --records`",
        "cargo install --locked",
    ];
    let names_flag = |line: &&str| {
        let message =
            line.split_once('"').map_or("", |(code, message)| if code.contains("//") { "" } else { message });
        let flag = message
            .match_indices("--")
            .any(|(at, _)| message[at + 2..].starts_with(|sign: char| sign.is_ascii_lowercase()));
        flag && !OF_OTHERS.iter().any(|of_other| line.contains(of_other))
    };
    for one in crates::all().iter().filter(|one| one.name != "calibrant-cli") {
        for (file, text) in one.sources.iter().filter(|(file, _)| !file.contains("/tests")) {
            let lines: Vec<&str> = text.lines().filter(names_flag).collect();
            assert!(lines.is_empty(), "{file}: name a TaskOption instead\n{}", lines.join("\n"));
        }
    }
}

#[test]
fn files_hold_one_idea() {
    for one in crates::all() {
        for (file, text) in &one.sources {
            let lines = text.lines().count();
            assert!(lines <= 500, "{file} has {lines} lines: split it");
        }
    }
}
