//! The page of the documentation on JSON files, from their schemas.

use super::keys::{first_paragraph, key_table, meaning, type_of};
use super::kinds::{FileKind, generator};
use calibrant_report::number_format::capitalised;
use serde_json::{Map, Value};

/// The head of the page.
const HEAD: &str = "# JSON files\n
<!-- Made from the types that are written: cargo run -p calibrant --features programs --example json_page > docs/json.md -->\n
Every file says `schema`, the version of all of them, `kind` and `program`; a list says nothing of the kind. `calibrant schema KIND` prints the JSON Schema of a kind.
A key with `?` is left out where there is nothing to say. What is not known is `null`, and so is a number that is not finite. Vectors are lists over the axes, matrices lists of rows.
Keys end in their unit; where the unit follows from the readings, it stands beside the number.
";

/// The text of `docs/json.md`: the kinds of files with their keys, and the types within them.
#[must_use]
pub fn json_page() -> String {
    let mut generator = generator();
    let schemas: Vec<Value> = FileKind::ALL.iter().map(|kind| kind.part(&mut generator).to_value()).collect();
    let types = generator.take_definitions(true);
    let mut text = HEAD.to_owned();
    for (FileKind { name, file, command, .. }, schema) in FileKind::ALL.iter().zip(&schemas) {
        let about = about(schema, &types);
        text.push_str(&format!("\n## {name}\n\n{about}\n`calibrant {command}` writes it: {file}.\n"));
        text.push_str(&body(schema, &types));
    }
    text.push_str("\n## Types\n");
    for (name, schema) in &types {
        text.push_str(&format!("\n### {name}\n\n{}\n{}", about(schema, &types), body(schema, &types)));
    }
    text
}

/// The keys of an object, or the type of another value.
fn body(schema: &Value, types: &Map<String, Value>) -> String {
    match key_table(schema, types) {
        keys if keys.is_empty() => format!("\n{}.\n", capitalised(&type_of(schema))),
        keys => keys,
    }
}

/// What a schema says of itself, in one line.
fn about(schema: &Value, types: &Map<String, Value>) -> String {
    meaning(schema, types).map_or_else(String::new, first_paragraph)
}
