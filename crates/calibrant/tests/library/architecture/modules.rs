//! Reads the modules of a crate from its sources, for the architecture test.

use std::collections::{BTreeMap, BTreeSet};

use super::tokens::{after_group, tokens};

/// A path as it is written: `crate::sensor::Imu`.
pub(crate) type Path = Vec<String>;

/// The declarations and names of a module.
#[derive(Debug, Default)]
pub(crate) struct Module {
    /// the file that holds it
    pub(crate) file: String,
    pub(crate) parent: Option<usize>,
    pub(crate) children: BTreeMap<String, usize>,
    /// the items it defines
    pub(crate) items: BTreeSet<String>,
    /// the names that `use` brings, each with the paths behind it
    pub(crate) imports: BTreeMap<String, Vec<Path>>,
    /// the paths before `::*`
    pub(crate) globs: Vec<Path>,
    /// the paths it names: in private `use`s and in code
    pub(crate) named: Vec<Path>,
}

/// All modules of a workspace.
#[derive(Debug, Default)]
pub(crate) struct Modules {
    pub(crate) all: Vec<Module>,
    /// the root module of each crate, by its name in code
    pub(crate) roots: BTreeMap<String, usize>,
    /// modules that are declared and have no file
    pub(crate) without_file: Vec<String>,
    /// macros that stand in the root of their crate, each with the module that holds it
    exported: Vec<(usize, String)>,
}

impl Modules {
    /// Reads one crate: `sources` are texts by file name, `root` the name of `lib.rs` or `main.rs`.
    pub(crate) fn read_crate(&mut self, name: &str, root: &str, sources: &BTreeMap<String, String>) {
        let index = self.read_file(None, root, sources);
        self.roots.insert(name.replace('-', "_"), index);
        for (module, name) in std::mem::take(&mut self.exported) {
            let path = self.path_of(module).into_iter().chain([name.clone()]).collect();
            self.all[index].imports.entry(name).or_default().push(path);
        }
    }

    /// The path of a module: `crate::json::name`.
    fn path_of(&self, module: usize) -> Path {
        let Some(parent) = self.all[module].parent else { return vec!["crate".to_owned()] };
        let children = &self.all[parent].children;
        let name = children.iter().find(|(_, child)| **child == module).map(|(name, _)| name.clone());
        self.path_of(parent).into_iter().chain(name).collect()
    }

    /// The files from which the modules were read.
    pub(crate) fn files(&self) -> BTreeSet<&str> {
        self.all.iter().map(|module| module.file.as_str()).collect()
    }

    /// The root module of a module's crate.
    pub(crate) fn root_of(&self, module: usize) -> usize {
        let mut root = module;
        while let Some(parent) = self.all[root].parent {
            root = parent;
        }
        root
    }

    fn read_file(&mut self, parent: Option<usize>, file: &str, sources: &BTreeMap<String, String>) -> usize {
        let index = self.add(parent, file);
        self.read_items(index, &tokens(&sources[file]), sources);
        index
    }

    fn add(&mut self, parent: Option<usize>, file: &str) -> usize {
        self.all.push(Module { file: file.to_owned(), parent, ..Module::default() });
        self.all.len() - 1
    }

    fn read_items(&mut self, module: usize, tokens: &[String], sources: &BTreeMap<String, String>) {
        let at = |place: usize| tokens.get(place).map_or("", String::as_str);
        let (mut place, mut depth) = (0, 0_usize);
        while place < tokens.len() {
            match tokens[place].as_str() {
                "{" | "(" | "[" => depth += 1,
                "}" | ")" | "]" => depth -= 1,
                "use" if at(place + 1) != "<" => {
                    let end =
                        (place..tokens.len()).find(|place| tokens[*place] == ";").unwrap_or(tokens.len());
                    self.read_use(module, &tokens[place + 1..end], is_public(&tokens[..place]));
                    place = end;
                }
                "mod" if depth == 0 && at(place + 2) == "{" => {
                    let end = after_group(tokens, place + 2);
                    let file = self.all[module].file.clone();
                    let child = self.add(Some(module), &file);
                    self.all[module].children.insert(tokens[place + 1].clone(), child);
                    self.read_items(child, &tokens[place + 3..end - 1], sources);
                    place = end - 1;
                }
                "mod" if depth == 0 && at(place + 2) == ";" => {
                    self.read_child(module, &tokens[place + 1], sources);
                    place += 2;
                }
                "struct" | "enum" | "union" | "trait" | "type" | "fn" | "const" | "static" if depth == 0 => {
                    // neither `const fn f` nor the type `fn(…)`
                    let name = at(place + 1);
                    let is_item = starts_path(name) && !matches!(name, "fn" | "unsafe" | "extern" | "_");
                    if is_item {
                        self.all[module].items.insert(name.to_owned());
                        place += 1;
                    }
                }
                "macro_rules" if depth == 0 => {
                    self.all[module].items.insert(at(place + 2).to_owned());
                    // types that the macro defines are the module's, since it is called there
                    let body = &tokens[place..after_group(tokens, place + 3)];
                    let types = body.windows(2).filter(|two| matches!(two[0].as_str(), "enum" | "struct"));
                    let names = types.map(|two| two[1].clone()).filter(|name| starts_path(name));
                    self.all[module].items.extend(names);
                    if at(place.wrapping_sub(2)) == "macro_export" {
                        self.exported.push((module, at(place + 2).to_owned()));
                    }
                    place += 2;
                }
                "checks" if depth == 0 && at(place + 1) == "!" => {
                    // a type for each entry, `HoldMoved "hold-moved" Warning`, and the list of the codes
                    let severity = |word: &str| matches!(word, "Note" | "Warning" | "Error");
                    let body = &tokens[place..after_group(tokens, place + 2)];
                    let entries = body.windows(3).filter(|three| three[1] == "\"" && severity(&three[2]));
                    let names = entries.map(|three| three[0].clone()).chain(["CODES".to_owned()]);
                    self.all[module].items.extend(names);
                    self.all[module].named.push(vec!["checks".to_owned()]);
                }
                word if starts_path(word) && !matches!(at(place.wrapping_sub(1)), "::" | "." | "fn") => {
                    if depth == 0 && at(place + 1) == "!" && at(place + 2) == "{" {
                        // types that are handed to a macro are the module's
                        let body = &tokens[place..after_group(tokens, place + 2)];
                        let types = body.windows(3).filter(|three| three[0] == "pub" && three[1] == "struct");
                        self.all[module].items.extend(types.map(|three| three[2].clone()));
                    }
                    let mut path = vec![word.to_owned()];
                    while at(place + 1) == "::" && starts_path(at(place + 2)) {
                        path.push(at(place + 2).to_owned());
                        place += 2;
                    }
                    // a single lower-case word is a variable or a field, unless it is called
                    let is_name = path.len() > 1
                        || word.starts_with(char::is_uppercase)
                        || matches!(at(place + 1), "(" | "!" | "::");
                    if is_name {
                        self.all[module].named.push(path);
                    }
                }
                _ => {}
            }
            place += 1;
        }
    }

    fn read_child(&mut self, module: usize, name: &str, sources: &BTreeMap<String, String>) {
        let file = &self.all[module].file;
        let (folder, last) = file.rsplit_once('/').unwrap_or(("", file));
        let folder = match last {
            "mod.rs" | "lib.rs" | "main.rs" => folder.to_owned(),
            _ => file.trim_end_matches(".rs").to_owned(),
        };
        let places = [format!("{folder}/{name}.rs"), format!("{folder}/{name}/mod.rs")];
        match places.iter().find(|file| sources.contains_key(*file)) {
            Some(file) => {
                let child = self.read_file(Some(module), file, sources);
                self.all[module].children.insert(name.to_owned(), child);
            }
            None => self.without_file.push(places[0].clone()),
        }
    }

    fn read_use(&mut self, module: usize, tree: &[String], public: bool) {
        let mut leaves = Vec::new();
        use_leaves(&[], tree, &mut leaves);
        let module = &mut self.all[module];
        for (name, path) in leaves {
            if !public {
                module.named.push(path.clone());
            }
            match name.as_str() {
                "*" => module.globs.push(path),
                _ => module.imports.entry(name).or_default().push(path),
            }
        }
    }
}

fn starts_path(word: &str) -> bool {
    word.starts_with(|sign: char| sign.is_alphabetic() || sign == '_')
}

/// Whether `pub` or `pub(…)` stands at the end of these tokens.
fn is_public(before: &[String]) -> bool {
    match before.last().map(String::as_str) {
        Some("pub") => true,
        Some(")") => {
            let open = before.iter().rposition(|token| token == "(").unwrap_or(0);
            open > 0 && before[open - 1] == "pub"
        }
        _ => false,
    }
}

/// The names that a use tree brings, with their paths: `a::{b, c as d, e::*}`.
fn use_leaves(before: &[String], tree: &[String], leaves: &mut Vec<(String, Path)>) {
    let mut path = before.to_vec();
    let mut place = 0;
    while place < tree.len() {
        match tree[place].as_str() {
            "::" => {}
            "*" => return leaves.push(("*".to_owned(), path)),
            "as" => return leaves.push((tree[place + 1].clone(), path)),
            "{" => {
                let end = after_group(tree, place) - 1;
                let mut start = place + 1;
                while start < end {
                    let stop = next_comma(tree, start, end);
                    use_leaves(&path, &tree[start..stop], leaves);
                    start = stop + 1;
                }
                return;
            }
            "self" if !path.is_empty() => {}
            word => path.push(word.to_owned()),
        }
        place += 1;
    }
    if let Some(name) = path.last() {
        leaves.push((name.clone(), path.clone()));
    }
}

fn next_comma(tree: &[String], start: usize, end: usize) -> usize {
    let mut place = start;
    while place < end && tree[place] != "," {
        place = if tree[place] == "{" { after_group(tree, place) } else { place + 1 };
    }
    place
}
