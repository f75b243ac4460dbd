//! Tests of the graph on small made-up sources: what it must find and what it must not find.

use std::collections::BTreeMap;

use super::crates::dependencies;
use super::graph::Graph;
use super::modules::Modules;

fn graph(sources: &[(&str, &str)]) -> Graph {
    let mut modules = Modules::default();
    let mut crates: BTreeMap<&str, BTreeMap<String, String>> = BTreeMap::new();
    for (file, text) in sources {
        let name = file.split('/').next().unwrap_or_default();
        crates.entry(name).or_default().insert((*file).to_owned(), (*text).to_owned());
    }
    for (name, sources) in crates {
        modules.read_crate(name, &format!("{name}/lib.rs"), &sources);
    }
    assert!(modules.without_file.is_empty(), "{:?}", modules.without_file);
    let graph = Graph::new(&modules);
    assert!(graph.unresolved.is_empty(), "{:?}", graph.unresolved);
    graph
}

fn uses(graph: &Graph, file: &str) -> Vec<String> {
    graph.edges[file].keys().cloned().collect()
}

#[test]
fn a_circle_through_a_re_export_is_found() {
    let graph = graph(&[
        ("a/lib.rs", "mod fit;"),
        ("a/fit/mod.rs", "mod lower; mod upper; pub use lower::Lower; pub use upper::upper;"),
        ("a/fit/lower.rs", "pub struct Lower; fn f() { crate::fit::upper(); }"),
        ("a/fit/upper.rs", "use super::Lower; pub fn upper(_: Lower) {}"),
    ]);
    assert_eq!(graph.circles(), [["a/fit/lower.rs", "a/fit/upper.rs"]]);
    let words = graph.describe(&graph.circles()[0]);
    assert!(words.contains("a/fit/lower.rs → a/fit/upper.rs (crate::fit::upper)"), "{words}");
    assert!(words.contains("a/fit/upper.rs → a/fit/lower.rs (super::Lower)"), "{words}");
}

#[test]
fn a_helper_in_mod_rs_closes_a_circle() {
    let graph = graph(&[
        ("a/lib.rs", "mod fit;"),
        ("a/fit/mod.rs", "mod child;\npub(crate) fn helper() {}\npub fn fit() { child::work(); }"),
        ("a/fit/child.rs", "pub(super) fn work() { super::helper(); }"),
    ]);
    assert_eq!(graph.circles(), [["a/fit/child.rs", "a/fit/mod.rs"]]);
}

#[test]
fn a_re_export_that_mod_rs_uses_itself_is_an_edge() {
    let graph = graph(&[
        ("a/lib.rs", "mod fit;"),
        ("a/fit/mod.rs", "mod child; pub use child::Child; pub fn helper(_: Child) {}"),
        ("a/fit/child.rs", "use super::helper; pub struct Child;"),
    ]);
    assert_eq!(graph.circles().len(), 1);
}

#[test]
fn declarations_and_re_exports_are_no_edges() {
    let graph = graph(&[
        ("a/lib.rs", "pub mod fit; pub use fit::{One, two as deux};"),
        ("a/fit/mod.rs", "mod one; pub(crate) mod two; pub use one::One; pub(crate) use two::two;"),
        ("a/fit/one.rs", "pub struct One;"),
        ("a/fit/two.rs", "use crate::One; pub fn two() {}"),
    ]);
    assert!(uses(&graph, "a/lib.rs").is_empty());
    assert!(uses(&graph, "a/fit/mod.rs").is_empty());
    assert_eq!(uses(&graph, "a/fit/two.rs"), ["a/fit/one.rs"]);
    assert!(graph.circles().is_empty());
}

#[test]
fn comments_strings_and_tests_are_no_edges() {
    let text = r##"
        //! Like [`crate::two::Two`].
        /* use crate::two::Two; /* crate::two::Two */ crate::two::Two */
        const A: &str = "crate::two::Two"; // crate::two::Two
        const B: &str = r#"a " crate::two::Two"#;
        fn f<'a>(_: &'a u8) -> char { '"' }
        #[cfg(test)]
        use crate::two::Two;
        #[cfg(test)]
        #[allow(missing_docs)]
        fn g(_: [u8; 2]) { crate::two::Two; }
        #[cfg(test)]
        mod one_tests;
        #[cfg(test)]
        mod tests { use crate::two::Two; }
        pub struct One;
    "##;
    let graph = graph(&[
        ("a/lib.rs", "mod one; mod two;"),
        ("a/one.rs", text),
        ("a/two.rs", "use crate::one::One; pub struct Two;"),
    ]);
    assert!(uses(&graph, "a/one.rs").is_empty());
    assert_eq!(uses(&graph, "a/two.rs"), ["a/one.rs"], "what follows the tests is read");
}

#[test]
fn every_way_of_naming_is_followed() {
    let graph = graph(&[
        ("a/lib.rs", "mod one; mod two; pub mod three; mod four; mod five; mod six;"),
        ("a/one.rs", "use crate::{\n    two::{self, Two},\n    three::deep::*,\n};\nfn f() { two::g(); X }"),
        ("a/two.rs", "pub struct Two; pub fn g() { self::h(); } fn h() {}"),
        ("a/three/mod.rs", "pub mod deep; use crate::two::Two;"),
        (
            "a/three/deep.rs",
            "pub const X: u8 = 0; fn f(_: super::Two) {} fn g() { super::super::four::fit(); }",
        ),
        ("a/four.rs", "pub mod fit; pub use fit::fit; fn f() { crate::five!(); }"),
        ("a/four/fit.rs", "pub fn fit() {} pub enum Kind { A } fn f() { use self::Kind::A; }"),
        ("a/five.rs", "type F = fn(u8) -> u8; macro_rules! five { () => {} } pub(crate) use five;"),
        (
            "a/six.rs",
            "use crate::four::fit; fn f(_: fit::Kind, v: Vec<crate::two::Two>) { <crate::three::deep::X>::x() }",
        ),
    ]);
    assert_eq!(uses(&graph, "a/one.rs"), ["a/three/deep.rs", "a/two.rs"]);
    assert!(uses(&graph, "a/two.rs").is_empty());
    assert_eq!(uses(&graph, "a/three/deep.rs"), ["a/four/fit.rs", "a/two.rs"]);
    assert_eq!(uses(&graph, "a/six.rs"), ["a/four/fit.rs", "a/three/deep.rs", "a/two.rs"]);
}

#[test]
fn paths_into_other_crates_are_followed() {
    let graph = graph(&[
        ("a_b/lib.rs", "pub mod one; mod two; pub use two::Two;"),
        ("a_b/one.rs", "pub struct One;"),
        ("a_b/two.rs", "pub struct Two;"),
        ("facade/lib.rs", "pub use a_b::one; mod own;"),
        ("facade/own.rs", "use crate::one::One; use a_b::Two; use elsewhere::Three;"),
    ]);
    assert_eq!(uses(&graph, "facade/own.rs"), ["a_b/one.rs", "a_b/two.rs"]);
}

#[test]
fn dependencies_are_read_without_those_of_tests() {
    let manifest = "[dependencies]\n# low.workspace = true\ncsv.workspace = true\nlow = { path = \"x\" }\n\n[dependencies.long]\nversion = \"1\"\n[dev-dependencies]\ntest-only = \"1\"";
    assert_eq!(dependencies(manifest).into_iter().collect::<Vec<_>>(), ["csv", "long", "low"]);
}

#[test]
fn a_type_that_a_macro_defines_belongs_to_its_file() {
    let graph = graph(&[
        ("a/lib.rs", "mod one; mod two;"),
        (
            "a/one.rs",
            "macro_rules! codes { ($($c:ident)*) => { pub enum Code { $($c,)* } }; } codes! { A B }",
        ),
        ("a/two.rs", "use crate::one::Code;"),
    ]);
    assert!(graph.unresolved.is_empty(), "{:?}", graph.unresolved);
    assert!(graph.edges["a/two.rs"].contains_key("a/one.rs"));
}
