//! The page of the documentation on JSON files, from their schemas.

use super::keys::{first_paragraph, key_table, meaning, type_of};
use super::kinds::{FileKind, generator};
use calibrant_report::number_format::capitalised;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// The head of the page.
const HEAD: &str = "# JSON files\n
<!-- Made from the types that are written: cargo run -p calibrant --features programs,records --example json_page > docs/json.md -->\n
Every file says `schema`, the version of all of them, `program`, and as `kind` the name of its chapter here; a list says none of them. `calibrant schema KIND` prints the JSON Schema of a kind.
A key with `?` is left out where there is nothing to say. What is not known is `null`, and so is a number that is not finite. Vectors are lists over the axes, matrices lists of rows.
Keys end in their unit; where the unit follows from the readings, it stands beside the number.
";

/// The text of `docs/json.md`: the kinds of files with their keys, and the types within them.
#[must_use]
pub fn json_page() -> String {
    let mut generator = generator();
    let schemas: Vec<Value> = FileKind::ALL.iter().map(|kind| kind.part(&mut generator).to_value()).collect();
    let types = generator.take_definitions(true);
    let kinds: BTreeMap<_, _> = FileKind::ALL.iter().map(|kind| ((kind.type_name)(), kind.name)).collect();
    let mut text = HEAD.to_owned();
    for (FileKind { name, file, command, .. }, schema) in FileKind::ALL.iter().zip(&schemas) {
        let about = about(schema, &types);
        text.push_str(&format!("\n## {name}\n\n{about}\n`calibrant {command}` writes it: {file}.\n"));
        text.push_str(&body(schema, &types));
    }
    text.push_str("\n## Types\n");
    for (name, schema) in types.iter().filter(|(name, _)| !kinds.contains_key(name.as_str())) {
        text.push_str(&format!("\n### {name}\n\n{}\n{}", about(schema, &types), body(schema, &types)));
    }
    // a file within another is the kind of that name
    for (file, kind) in kinds {
        text = text.replace(&format!("[{file}](#{})", file.to_lowercase()), &format!("[{kind}](#{kind})"));
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
