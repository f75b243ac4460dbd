//! Errors of the library as exceptions of Python. The classes are in `calibrant._exceptions`.

use crate::wording::argument;
use calibrant::Error;
use calibrant::error::{InputError, Refusal, TaskOption};
use pyo3::prelude::*;
use serde_json::{Value, json};

/// The exception of an error.
pub(crate) fn raised(py: Python<'_>, error: &Error) -> PyErr {
    exception(py, &as_json(error))
}

/// The exception where the library itself failed.
pub(crate) fn internal(py: Python<'_>, message: &str) -> PyErr {
    exception(py, &internal_error(message))
}

/// What an exception needs where the library itself failed.
pub(crate) fn internal_error(message: &str) -> Value {
    let text = format!("calibrant failed inside: {message}");
    let remedy = "keep the input, and report it";
    json!({ "kind": "internal", "code": "internal-error", "message": text, "remedy": remedy })
}

/// The error about an argument.
pub(crate) fn invalid(message: impl Into<String>, help: impl Into<String>) -> Error {
    Error::experiment(InputError::new(Refusal::ValueInvalid, message, help))
}

fn exception(py: Python<'_>, data: &Value) -> PyErr {
    let made = py
        .import("calibrant._exceptions")
        .and_then(|module| module.getattr("of_json"))
        .and_then(|of_json| of_json.call1((data.to_string(),)));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// The argument that answers: the format of a calibration is the only question that `from` answers.
fn asked(option: TaskOption) -> &'static str {
    if option == TaskOption::From { "format" } else { argument(option) }
}

/// What an exception needs of an error. Tables of failures take it, too.
pub(crate) fn as_json(error: &Error) -> Value {
    let code = error.code();
    let about = |kind: &str, of: &InputError| {
        let answers = of
            .answers
            .iter()
            .map(|answer| json!({ "option": asked(answer.option), "values": answer.values }));
        json!({
            "kind": kind, "code": code.name(), "message": of.message, "remedy": of.help, "key": of.key,
            "path": of.file.as_ref().map(|file| file.display().to_string()), "line": of.line, "column": of.column,
            "answers": answers.collect::<Vec<_>>(),
        })
    };
    match error {
        Error::Experiment(of) => about("experiment", of),
        Error::Infeasible(of) => about("infeasible", of),
        Error::Recording(of) => about("recording", of),
        Error::NotIdentifiable(of) => json!({
            "kind": "not-identifiable", "code": code.name(), "message": error.to_string(), "remedy": code.remedy(),
            "groups": of.groups,
        }),
        Error::Output { path, .. } => json!({
            "kind": "output", "code": code.name(), "message": error.to_string(), "remedy": code.remedy(),
            "path": path.display().to_string(),
        }),
        other => json!({
            "kind": "other", "code": code.name(), "message": other.to_string(), "remedy": code.remedy(),
        }),
    }
}
