//! The page of the documentation on JSON files, from their schemas.

use super::keys::{key_table, type_of};
use super::kinds::FileKind;
use calibrant_report::number_format::capitalised;
use schemars::SchemaGenerator;
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
    let mut generator = SchemaGenerator::default();
    let schemas: Vec<Value> = FileKind::ALL.iter().map(|kind| kind.part(&mut generator).to_value()).collect();
    let types = generator.take_definitions(true);
    let mut text = HEAD.to_owned();
    for (kind, schema) in FileKind::ALL.iter().zip(&schemas) {
        let file = capitalised(kind.file);
        text.push_str(&format!(
            "\n## {}\n\n{file}, by `calibrant {}`.{}\n",
            kind.name,
            kind.command,
            about(schema)
        ));
        text.push_str(&body(schema, &types));
    }
    text.push_str("\n## Types\n");
    for (name, schema) in &types {
        text.push_str(&format!("\n### {name}\n\n{}\n{}", about(schema).trim(), body(schema, &types)));
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

/// What a schema says of itself, in one line, after a blank; nothing where it says nothing.
fn about(schema: &Value) -> String {
    schema["description"].as_str().map_or_else(String::new, |about| format!(" {}", about.replace('\n', " ")))
}
