//! The graph of the architecture test: which file uses which. It follows paths through re-exports to the file
//! that defines the item.

use std::collections::{BTreeMap, BTreeSet};

use super::modules::{Modules, Path};

/// For each file the files that it uses, each with a path that it names.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    pub(crate) edges: BTreeMap<String, BTreeMap<String, String>>,
    /// paths into the workspace whose item was not found
    pub(crate) unresolved: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Target {
    /// an item that the module at this index defines
    Item(usize),
    Module(usize),
    /// a library from elsewhere, a variable, a generic
    Foreign,
    Missing,
}

impl Graph {
    pub(crate) fn new(modules: &Modules) -> Self {
        let mut graph = Self::default();
        for (index, module) in modules.all.iter().enumerate() {
            let used = graph.edges.entry(module.file.clone()).or_default();
            for path in &module.named {
                match resolve(modules, index, path, Kind::Item, &mut Open::new()) {
                    Target::Item(defining) if modules.all[defining].file != module.file => {
                        used.entry(modules.all[defining].file.clone()).or_insert_with(|| path.join("::"));
                    }
                    Target::Missing => graph.unresolved.push(format!("{}: {}", module.file, path.join("::"))),
                    Target::Item(_) | Target::Module(_) | Target::Foreign => {}
                }
            }
        }
        graph
    }

    /// The circles: sets of more than one file, each of which reaches all others.
    pub(crate) fn circles(&self) -> Vec<Vec<&str>> {
        let reached: BTreeMap<&str, BTreeSet<&str>> =
            self.edges.keys().map(|file| (file.as_str(), self.reached_from(file))).collect();
        let mut circles = Vec::new();
        let mut seen = BTreeSet::new();
        for (file, from) in &reached {
            let circle: Vec<&str> = from
                .iter()
                .copied()
                .filter(|other| reached.get(other).is_some_and(|back| back.contains(file)))
                .collect();
            if circle.len() > 1 && seen.insert(circle.clone()) {
                circles.push(circle);
            }
        }
        circles
    }

    /// A circle in words: each file with the files of the circle that it uses.
    pub(crate) fn describe(&self, circle: &[&str]) -> String {
        let mut words = format!("a circle of {} files:\n", circle.len());
        for file in circle {
            for (used, path) in self.edges[*file].iter().filter(|(used, _)| circle.contains(&used.as_str())) {
                words += &format!("  {file} → {used} ({path})\n");
            }
        }
        words
    }

    fn reached_from<'a>(&'a self, start: &str) -> BTreeSet<&'a str> {
        let mut reached = BTreeSet::new();
        let mut open = vec![start];
        while let Some(file) = open.pop() {
            for used in self.edges.get(file).into_iter().flat_map(BTreeMap::keys) {
                if reached.insert(used.as_str()) {
                    open.push(used);
                }
            }
        }
        reached
    }
}

/// The names that are being resolved, so that a name that leads to itself ends.
type Open = Vec<(usize, String, Kind)>;

/// The kind of a name: it can stand for an item and for a module at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Item,
    Module,
}

/// The target of a path that a module names. Its last word is of the wanted kind, if there is one.
fn resolve(modules: &Modules, from: usize, path: &Path, wanted: Kind, open: &mut Open) -> Target {
    let mut module = from;
    let mut rest = path.as_slice();
    while let Some((word, after)) = rest.split_first() {
        match word.as_str() {
            "crate" => module = modules.root_of(module),
            "self" => {}
            "super" => module = modules.all[module].parent.unwrap_or(module),
            _ => break,
        }
        rest = after;
    }
    let relative = rest.len() == path.len();
    for (place, word) in rest.iter().enumerate() {
        let kind = if place + 1 == rest.len() { wanted } else { Kind::Module };
        match lookup(modules, module, word, kind, open) {
            Target::Module(next) => module = next,
            Target::Missing if relative && place == 0 => match modules.roots.get(word) {
                Some(root) => module = *root,
                None => return Target::Foreign,
            },
            found => return found,
        }
    }
    Target::Module(module)
}

/// The meaning of a name in a module.
fn lookup(modules: &Modules, module: usize, word: &str, wanted: Kind, open: &mut Open) -> Target {
    let name = (module, word.to_owned(), wanted);
    if open.contains(&name) {
        return Target::Missing;
    }
    open.push(name);
    let here = &modules.all[module];
    let mut found = Vec::new();
    found.extend(here.items.contains(word).then_some(Target::Item(module)));
    found.extend(here.children.get(word).map(|child| Target::Module(*child)));
    for path in here.imports.get(word).into_iter().flatten() {
        found.push(resolve(modules, module, path, wanted, open));
    }
    for path in &here.globs {
        if let Target::Module(other) = resolve(modules, module, path, Kind::Module, open) {
            found.push(lookup(modules, other, word, wanted, open));
        }
    }
    open.pop();
    found.retain(|target| *target != Target::Missing);
    let is_wanted = |target: &&Target| match wanted {
        Kind::Item => matches!(target, Target::Item(_)),
        Kind::Module => matches!(target, Target::Module(_)),
    };
    found.iter().find(is_wanted).or(found.first()).copied().unwrap_or(Target::Missing)
}
