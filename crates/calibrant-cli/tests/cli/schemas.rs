//! What the commands write has the form that `calibrant schema` prints: every file that a test reads is checked.

use crate::bench::Bench;
use calibrant::FileKind;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Fails where a file of calibrant is not as the schema of its kind says. Files of others pass.
pub(crate) fn check(name: &str, value: &Value) {
    if let Some(kind) = kind_of(value) {
        check_kind(kind, name, value);
    }
}

/// Fails where a value is not as the schema of this kind says.
pub(crate) fn check_kind(kind: &str, name: &str, value: &Value) {
    static SCHEMAS: OnceLock<BTreeMap<&str, Value>> = OnceLock::new();
    let all = || FileKind::ALL.iter().map(|kind| (kind.name, kind.schema().to_value())).collect();
    let schema = SCHEMAS.get_or_init(all).get(kind).unwrap_or_else(|| panic!("{name}: no kind {kind}"));
    let faults = Form { definitions: &schema["$defs"] }.faults(schema, value, "");
    assert!(faults.is_empty(), "{name} is not of the kind {kind}:\n{}", faults.join("\n"));
}

/// The kind that a file says; `None` for one of another program.
fn kind_of(value: &Value) -> Option<&str> {
    let is_ours = value["program"].as_str()?.starts_with("calibrant ") && value["schema"] == 2;
    value["kind"].as_str().filter(|_| is_ours)
}

/// The part of JSON Schema that our schemas use.
struct Form<'s> {
    definitions: &'s Value,
}

impl Form<'_> {
    /// How a value differs from a schema, each with its place. Keys that the schema does not list are faults, too.
    fn faults(&self, schema: &Value, value: &Value, place: &str) -> Vec<String> {
        if let Some(name) = schema["$ref"].as_str() {
            let name = name.rsplit('/').next().expect("a name");
            return self.faults(&self.definitions[name], value, place);
        }
        if let Some(any) = schema["anyOf"].as_array().or_else(|| schema["oneOf"].as_array()) {
            let each: Vec<_> = any.iter().map(|one| self.faults(one, value, place)).collect();
            return each.into_iter().min_by_key(Vec::len).unwrap_or_default();
        }
        let fault = |what: &str| vec![format!("{place}: {what}")];
        if schema["enum"].as_array().is_some_and(|values| !values.contains(value)) {
            return fault(&format!("{value} is none of {}", schema["enum"]));
        }
        if let Some(only) = schema.get("const").filter(|only| *only != value) {
            return fault(&format!("{value} is not {only}"));
        }
        let types = match &schema["type"] {
            Value::Array(types) => types.iter().filter_map(Value::as_str).collect(),
            one => Vec::from_iter(one.as_str()),
        };
        if !types.is_empty() && !types.iter().any(|of| is_of(of, value)) {
            return fault(&format!("{value} is no {}", types.join(" or ")));
        }
        match value {
            Value::Object(entries) => {
                let known = |key: &str| schema["properties"].get(key).or(schema.get("additionalProperties"));
                let required = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
                let missing = required.filter(|key| !entries.contains_key(*key));
                let missing = missing.map(|key| format!("{place}: {key} is missing"));
                let of_entries = entries.iter().flat_map(|(key, entry)| match known(key) {
                    Some(schema) => self.faults(schema, entry, &format!("{place}.{key}")),
                    None => fault(&format!("{key} is not in the schema")),
                });
                missing.chain(of_entries).collect()
            }
            Value::Array(entries) => {
                let length = entries.len() as u64;
                let (least, most) = (schema["minItems"].as_u64(), schema["maxItems"].as_u64());
                if least.is_some_and(|least| length < least) || most.is_some_and(|most| length > most) {
                    return fault(&format!("{length} entries"));
                }
                let of = |(k, entry)| self.faults(&schema["items"], entry, &format!("{place}[{k}]"));
                entries.iter().enumerate().flat_map(of).collect()
            }
            _ => Vec::new(),
        }
    }
}

fn is_of(name: &str, value: &Value) -> bool {
    match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("the type {other} is not checked"),
    }
}

#[test]
fn what_does_not_have_the_form_is_found() {
    let schema = serde_json::json!({
        "type": "object", "required": ["a"], "$defs": { "Name": { "enum": ["x", "y"] } },
        "properties": {
            "a": { "type": ["number", "null"] },
            "b": { "type": "array", "items": { "anyOf": [{ "$ref": "#/$defs/Name" }, { "type": "null" }] }, "maxItems": 2 },
            "kind": { "type": "string", "const": "z" },
        },
    });
    let faults = |value: Value| Form { definitions: &schema["$defs"] }.faults(&schema, &value, "").join("; ");
    assert_eq!(faults(serde_json::json!({ "a": null, "b": ["x", null] })), "");
    assert_eq!(faults(serde_json::json!({ "c": 1 })), ": a is missing; : c is not in the schema");
    assert_eq!(faults(serde_json::json!({ "a": 1, "kind": "y" })), ".kind: \"y\" is not \"z\"");
    assert_eq!(faults(serde_json::json!({ "a": "1" })), ".a: \"1\" is no number or null");
    assert_eq!(faults(serde_json::json!({ "a": 1, "b": ["z"] })), ".b[0]: \"z\" is none of [\"x\",\"y\"]");
    assert_eq!(faults(serde_json::json!({ "a": 1, "b": ["x", "x", "y"] })), ".b: 3 entries");
}

#[test]
fn the_kinds_are_listed_and_each_has_its_schema() {
    let bench = Bench::new();
    let list = bench.run("schema").done().stdout;
    assert_eq!(list.lines().count(), FileKind::ALL.len());
    bench.write("fleet.json", bench.run("schema fleet").done().stdout);
    assert_eq!(
        bench.json("fleet.json")["properties"]["reference_c"]["type"],
        serde_json::json!(["number", "null"])
    );
    bench.refuses("schema flet", 2, &["fleet"]);
}
