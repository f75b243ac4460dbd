//! Codes of diagnostics: their names, their page, their words, and where they are produced.

use crate::common::messages;
use calibrant::diagnostic::{Code, Diagnostic, table_as_markdown};
use calibrant::sensor::Axis;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn the_page_of_the_documentation_is_that_of_the_table() {
    let page = std::fs::read_to_string(workspace().join("docs/diagnostics.md")).expect("read");
    assert_eq!(
        page,
        table_as_markdown(),
        "cargo run -p calibrant-core --example diagnostics > docs/diagnostics.md"
    );
}

#[test]
fn names_are_unique_and_in_kebab_case() {
    let names: BTreeSet<&str> = Code::ALL.iter().map(|code| code.name()).collect();
    assert_eq!(names.len(), Code::ALL.len());
    for code in Code::ALL {
        let name = code.name();
        let is_kebab =
            name.split('-').all(|word| !word.is_empty() && word.bytes().all(|c| c.is_ascii_lowercase()));
        assert!(is_kebab, "{name}");
        assert_eq!(Code::parse(name), Some(*code));
        let entry = code.entry();
        for text in [entry.meaning, entry.decided, entry.remedy] {
            assert!(text.ends_with('.') || text.ends_with('?'), "{name}: {text}");
        }
    }
    assert_eq!(Code::parse("no-such-code"), None);
}

/// Each code is made somewhere, and has words of its own.
#[test]
fn each_code_has_a_producer_and_words() {
    let (mut produced, mut words) = (String::new(), String::new());
    for folder in ["calibrant-core", "calibrant-machine", "calibrant-io", "calibrant", "calibrant-cli"] {
        collect(&workspace().join("crates").join(folder).join("src"), &mut produced);
    }
    collect(&workspace().join("crates/calibrant-report/src/words"), &mut words);
    // a finding of a reader has its code in one file, and a sentence for each by an exhaustive match
    let findings = workspace().join("crates/calibrant-io/src/recording/reader_finding.rs");
    let findings = std::fs::read_to_string(findings).expect("text");
    let of_reader = |code: &Code| {
        let end = |c: char| !c.is_ascii_alphanumeric();
        findings.split("Code::").skip(1).any(|rest| rest.split(end).next() == Some(&format!("{code:?}")))
    };
    for code in Code::ALL.iter().filter(|code| !of_reader(code)) {
        let made = |of: &str| format!("{of}::{code:?} ");
        let is_made = ["Diagnostic", "Self"].iter().any(|of| produced.contains(&made(of)));
        assert!(is_made, "{code:?} is produced nowhere");
        assert!(words.contains(&made("Diagnostic")), "{code:?} has no words");
    }
}

/// The text of all sources below a folder, but for the list of diagnostics.
fn collect(folder: &Path, text: &mut String) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, text);
        } else if !path.ends_with("diagnostic/value.rs") && !path.ends_with("diagnostic/code.rs") {
            text.push_str(&std::fs::read_to_string(&path).expect("text"));
        }
    }
}

#[test]
fn a_diagnostic_knows_its_subject_and_numbers() {
    let found = Diagnostic::ResidualsNotWhite { axis: Axis::Y, p_value: 1e-5 };
    assert_eq!((found.code(), found.subject().as_deref()), (Code::ResidualsNotWhite, Some("axis y")));
    assert_eq!(found.numbers(), [("p_value", 1e-5)]);
    let text = &messages(&[found])[0];
    assert!(text.starts_with("the residuals of axis y are not white (Ljung–Box p-value 1.0e-5)"), "{text}");
}
