//! Codes of diagnostics: their names, their page, their words, and where they are produced.

use crate::common::messages;
use calibrant::diagnostic::Check;
use calibrant::diagnostic::fit::ResidualsNotWhite;
use calibrant::diagnostic::validation::AccelerometerMoved;
use calibrant::diagnostic::{Code, Diagnostic, table_as_markdown};
use calibrant::sensor::Axis;
use nalgebra::Vector3;
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
    let names: BTreeSet<&str> = Code::all().map(Code::name).collect();
    assert_eq!(names.len(), Code::all().count());
    for code in Code::all() {
        let name = code.name();
        let is_kebab =
            name.split('-').all(|word| !word.is_empty() && word.bytes().all(|c| c.is_ascii_lowercase()));
        assert!(is_kebab, "{name}");
        assert_eq!(Code::parse(name), Some(code));
        let entry = code.entry();
        for text in [entry.meaning, entry.decided, entry.remedy] {
            assert!(text.ends_with('.') || text.ends_with('?'), "{name}: {text}");
        }
    }
    assert_eq!(Code::parse("no-such-code"), None);
}

/// Each check is decided somewhere, in a place of its own.
#[test]
fn each_code_has_a_producer() {
    let mut produced = String::new();
    let folders = [
        "calibrant-core",
        "calibrant-campaign",
        "calibrant-machine",
        "calibrant-recording",
        "calibrant-io",
        "calibrant",
        "calibrant-cli",
    ];
    for folder in folders {
        collect(&workspace().join("crates").join(folder).join("src"), &mut produced);
    }
    for code in Code::all() {
        let camel: String =
            code.name().split('-').map(|word| word[..1].to_uppercase() + &word[1..]).collect();
        let is_made = [" {", "::CODE", "::of("].iter().any(|end| produced.contains(&format!("{camel}{end}")));
        assert!(is_made, "{camel} is produced nowhere");
    }
}

/// The text of all sources below a folder, but for the entries of the checks.
fn collect(folder: &Path, text: &mut String) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() && !path.ends_with("calibrant-core/src/diagnostic") {
            collect(&path, text);
        } else if path.is_file() {
            text.push_str(&std::fs::read_to_string(&path).expect("text"));
        }
    }
}

#[test]
fn a_diagnostic_knows_its_subject_and_numbers() {
    let found = Diagnostic::from(ResidualsNotWhite { axis: Axis::Y, p_value: 1e-5 });
    assert_eq!((found.code(), found.subject()), (ResidualsNotWhite::CODE, Some("axis y")));
    assert_eq!(found.numbers(), [("p_value", 1e-5)]);
    let text = &messages(&[found])[0];
    assert!(text.starts_with("the residuals of axis y are not white (Ljung–Box p-value 1.0e-5)"), "{text}");
}

#[test]
fn a_vector_has_a_number_for_each_axis() {
    let (shift, sd) = (Vector3::new(0.052, 0.011, -0.033), Vector3::new(0.001, 0.001, 0.003));
    let moved = AccelerometerMoved {
        shift_mps2: Some(shift),
        shift_sd_mps2: Some(sd),
        change: None,
        change_sd: None,
    };
    let found = Diagnostic::from(moved);
    assert_eq!((found.number("x_shift_mps2"), found.number("z_shift_sd_mps2")), (Some(0.052), Some(0.003)));
    assert_eq!(found.number("x_change"), None);
    assert_eq!(
        found.sentence(),
        "The accelerometer has changed since the calibration: its bias by 52, 11, −33 mm/s² (up to 52 standard deviations). \
         That explains the gravity residuals. Calibrate it again."
    );
}
