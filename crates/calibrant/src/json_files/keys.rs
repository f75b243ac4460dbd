//! The keys of an object of a JSON Schema, as a table of the page.

use serde_json::{Map, Value};

/// The units that keys end in. The longest ending counts.
const UNITS: [(&str, &str); 20] = [
    ("_counts", "counts"),
    ("_deg", "°"),
    ("_hz", "Hz"),
    ("_radps", "rad/s"),
    ("_rad", "rad"),
    ("_mps", "m/s"),
    ("_mps2", "m/s²"),
    ("_mps3", "m/s³"),
    ("_mps2_per_sqrt_hz", "m/s²/√Hz"),
    ("_mps3_per_sqrt_hz", "m/s³/√Hz"),
    ("_radps_per_sqrt_hz", "rad/s/√Hz"),
    ("_radps2_per_sqrt_hz", "rad/s²/√Hz"),
    ("_m", "m"),
    ("_ppm", "ppm"),
    ("_per_k", "1/K"),
    ("_c", "°C"),
    ("_s", "s"),
    ("_in_sd", "sd"),
    ("_robust_sd", "sd"),
    ("_share", "1"),
];
/// An enumeration with more names is not listed.
const MOST_NAMES: usize = 12;

/// A table with a row for each key; nothing for a schema without keys. A key without a meaning of its own has that of its type.
pub(super) fn key_table(schema: &Value, definitions: &Map<String, Value>) -> String {
    let Some(properties) = schema["properties"].as_object() else { return String::new() };
    let is_required =
        |key: &str| schema["required"].as_array().is_some_and(|required| required.iter().any(|of| of == key));
    let row = |(key, of): (&String, &Value)| {
        let mark = if is_required(key) { "" } else { "?" };
        let meaning = meaning(of, definitions).map_or_else(String::new, first_paragraph).replace('|', "\\|");
        format!("| `{key}`{mark} | {} | {} | {meaning} |\n", type_of(of), unit_of(key))
    };
    let mut rows: String = properties.iter().map(row).collect();
    if let Some(others) = schema.get("additionalProperties").filter(|of| of.is_object()) {
        rows.push_str(&format!("| … | {} | | by its name |\n", type_of(others)));
    }
    format!("\n| key | type | unit | meaning |\n|---|---|---|---|\n{rows}")
}

/// The first paragraph of a doc comment in one line; names of code are no links.
pub(super) fn first_paragraph(text: &str) -> String {
    let paragraph = text.split("\n\n").next().unwrap_or_default().replace('\n', " ");
    let mut parts = paragraph.split("`](");
    let first = parts.next().unwrap_or_default().to_owned();
    let after_link = |part: &str| format!("`{}", part.split_once(')').map_or(part, |(_, after)| after));
    (first + &parts.map(after_link).collect::<String>()).replace("[`", "`").replace("`]", "`")
}

/// What a schema says of itself, or else the type within it.
pub(super) fn meaning<'s>(schema: &'s Value, definitions: &'s Map<String, Value>) -> Option<&'s str> {
    schema["description"].as_str().or_else(|| match (name_of(schema), alternatives(schema)) {
        (Some(name), _) => definitions.get(name)?["description"].as_str(),
        (None, Some(any)) => any.iter().find_map(|one| meaning(one, definitions)),
        (None, None) => meaning(schema.get("items")?, definitions),
    })
}

/// The name of the type that a schema stands for.
fn name_of(schema: &Value) -> Option<&str> {
    schema["$ref"].as_str()?.rsplit('/').next()
}

fn alternatives(schema: &Value) -> Option<&Vec<Value>> {
    schema["anyOf"].as_array().or_else(|| schema["oneOf"].as_array())
}

/// The unit that a key ends in.
fn unit_of(key: &str) -> &'static str {
    let endings = UNITS.iter().filter(|(ending, _)| key.ends_with(ending));
    endings.max_by_key(|(ending, _)| ending.len()).map_or("", |(_, unit)| unit)
}

/// A type in words: `list of numbers`, a link to a type of the page, the values of an enumeration.
pub(super) fn type_of(schema: &Value) -> String {
    if let Some(name) = name_of(schema) {
        return format!("[{name}](#{})", name.to_lowercase());
    }
    if let Some(any) = alternatives(schema) {
        return any.iter().map(type_of).collect::<Vec<_>>().join(" or ");
    }
    if let Some(values) = schema["enum"].as_array() {
        if values.len() > MOST_NAMES {
            return format!("one of {} names", values.len());
        }
        return values.iter().map(|value| format!("`{}`", plain(value))).collect::<Vec<_>>().join(", ");
    }
    if let Some(value) = schema.get("const") {
        return format!("`{}`", plain(value));
    }
    match &schema["type"] {
        Value::String(name) => simple(name, schema),
        Value::Array(names) => {
            let names = names.iter().filter_map(Value::as_str);
            names.map(|name| simple(name, schema)).collect::<Vec<_>>().join(" or ")
        }
        _ => "any".to_owned(),
    }
}

fn simple(name: &str, schema: &Value) -> String {
    match name {
        "array" => {
            let entries = schema.get("items").filter(|of| of.is_object());
            let entries = entries.map_or_else(|| "any".to_owned(), type_of);
            match (schema["minItems"].as_u64(), schema["maxItems"].as_u64()) {
                (Some(least), Some(most)) if least == most => format!("{least} × {entries}"),
                _ => format!("list of {entries}"),
            }
        }
        "object" => match schema.get("additionalProperties").filter(|of| of.is_object()) {
            Some(entries) => format!("map of {}", type_of(entries)),
            None => "object".to_owned(),
        },
        "string" => "text".to_owned(),
        other => other.to_owned(),
    }
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
