//! The calibrations of a batch as one JSON list.

use super::calibration::CalibrationFile;
use super::json::to_json;
use super::machine_calibration::MachineCalibrationFile;
use super::summary::Failure;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

/// The calibrations of several recordings as one JSON array, in their order. Each entry has its file, and
/// either the text of its calibration.json, or its error and the code of that.
///
/// # Examples
/// ```
/// use calibrant_io::{Failure, calibrations_json};
/// use calibrant_core::error::Refusal;
/// let failed = Failure { code: Refusal::FileEmpty, message: "the file is empty".into() };
/// let text = calibrations_json([("a.csv", Ok("{\"schema\": 2}\n")), ("b.csv", Err(&failed))]);
/// assert!(text.contains("\"error\": \"the file is empty\",\n    \"code\": \"file-empty\""));
/// ```
#[must_use]
pub fn calibrations_json<'a>(
    recordings: impl IntoIterator<Item = (&'a str, std::result::Result<&'a str, &'a Failure>)>,
) -> String {
    let entry = |(file, outcome): (&str, std::result::Result<&str, &Failure>)| {
        let quoted = |text: &str| to_json(&text).trim_end().to_owned();
        let outcome = match outcome {
            // no text of JSON has a line end within a string
            Ok(calibration) => {
                format!("\"calibration\": {}", calibration.trim_end().replace('\n', "\n    "))
            }
            Err(failure) => {
                format!("\"error\": {},\n    \"code\": \"{}\"", quoted(&failure.message), failure.code.name())
            }
        };
        format!("  {{\n    \"file\": {},\n    {outcome}\n  }}", quoted(file))
    };
    format!("[\n{}\n]\n", recordings.into_iter().map(entry).collect::<Vec<_>>().join(",\n"))
}

/// An entry of [`calibrations_json`]: gives the schema of what is written as text.
#[derive(Debug, Clone, Copy)]
pub struct BatchEntry;

impl JsonSchema for BatchEntry {
    fn schema_name() -> Cow<'static, str> {
        "BatchEntry".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let calibration = [
            generator.subschema_for::<CalibrationFile<'_>>(),
            generator.subschema_for::<MachineCalibrationFile<'_>>(),
        ];
        json_schema!({
            "type": "object",
            "description": "A recording, and its calibration or the reason why there is none.",
            "properties": {
                "file": { "type": "string", "description": "The recording, as it was given." },
                "calibration": { "anyOf": calibration, "description": "What calibration.json says." },
                "error": { "type": "string", "description": "Why there is no calibration." },
                "code": { "type": "string", "description": "The code of this error." },
            },
            "required": ["file"],
        })
    }
}
