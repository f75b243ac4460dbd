//! What a user should know about a result.

use super::code::Code;
use super::numbers::Numbers;
use super::parts::Parts;
use super::severity::Severity;
use crate::error::with_options_worded;
use crate::number_format::capitalised;
use crate::sensor::SensorKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What a user should know about a result: a code, a subject, numbers, and a sentence.
///
/// It is made of what a [`Check`](super::Check) found. Its `Display` is the place and the sentence: `line 7: gyroscope: axis x never changes…`.
///
/// # Examples
/// ```
/// use calibrant_core::diagnostic::Diagnostic;
/// use calibrant_core::diagnostic::datasheet::ScaleNegative;
/// use calibrant_core::sensor::Axis;
/// let found = Diagnostic::from(ScaleNegative { axis: Axis::Y });
/// assert_eq!(found.code().name(), "scale-negative");
/// assert_eq!(found.message(), "the scale factor of axis y is negative. Is the axis reversed?");
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Diagnostic {
    /// What was found, by its code.
    code: Code,
    /// How much it matters.
    severity: Severity,
    /// The file that it is about.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    /// The line of its first occurrence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    line: Option<usize>,
    /// The sensor that it is about, where the recording has two, and its sentence does not name it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sensor: Option<SensorKind>,
    /// What it is about, such as `gyroscope axis x`. Without it: the whole result.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    subject: Option<String>,
    /// By their names, which end in the unit.
    #[schemars(with = "std::collections::BTreeMap<String, Option<f64>>")]
    numbers: Numbers,
    /// What was found, and what to do.
    message: String,
}

impl Diagnostic {
    pub(super) fn new(code: Code, parts: Parts, message: String) -> Self {
        let subject = (!parts.subject.is_empty()).then(|| parts.subject.join(" "));
        Self {
            code,
            severity: code.severity(),
            file: None,
            line: None,
            sensor: None,
            subject,
            numbers: parts.numbers,
            message: with_options_worded(message),
        }
    }

    /// The same, at this line of its file, from 1.
    #[must_use]
    pub fn at_line(self, line: Option<usize>) -> Self {
        Self { line, ..self }
    }

    /// The same, about this sensor of two.
    #[must_use]
    pub fn about(self, sensor: Option<SensorKind>) -> Self {
        Self { sensor, ..self }
    }

    /// The same, found in this file.
    #[must_use]
    pub fn in_file(self, name: impl Into<String>) -> Self {
        Self { file: Some(name.into()), ..self }
    }

    /// The same, with the severity [`Severity::Allowed`] if its code is one of these.
    #[must_use]
    pub fn allowed_by(self, allowed: &[Code]) -> Self {
        let severity = if allowed.contains(&self.code) { Severity::Allowed } else { self.severity };
        Self { severity, ..self }
    }

    /// Its code.
    #[must_use]
    pub fn code(&self) -> Code {
        self.code
    }

    /// How much it matters.
    #[must_use]
    pub fn severity(&self) -> Severity {
        self.severity
    }

    /// Is it more than a note: does the result become doubtful?
    #[must_use]
    pub fn is_warning(&self) -> bool {
        self.severity >= Severity::Warning
    }

    /// The file that it is about, where a reader found it.
    #[must_use]
    pub fn file(&self) -> Option<&str> {
        self.file.as_deref()
    }

    /// The line of its first occurrence, from 1.
    #[must_use]
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// Its subject, such as `gyroscope axis x` or `hold 3`. `None`: the whole result.
    #[must_use]
    pub fn subject(&self) -> Option<&str> {
        self.subject.as_deref()
    }

    /// Its numbers by name. Names end in the unit where there is one.
    #[must_use]
    pub fn numbers(&self) -> Vec<(&str, f64)> {
        self.numbers.iter().collect()
    }

    /// The number of this name.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        self.numbers.iter().find(|(of, _)| *of == name).map(|(_, value)| value)
    }

    /// Its sentence: what was found, and what to do. It starts with a small letter.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Its message as a sentence of a page.
    #[must_use]
    pub fn sentence(&self) -> String {
        let end = if self.message.ends_with(['.', '?', '!', ')']) { "" } else { "." };
        capitalised(&self.message) + end
    }

    /// Its message behind the line and the sensor, without the file.
    #[must_use]
    pub fn without_file(&self) -> String {
        let line = self.line.map_or_else(String::new, |line| format!("line {line}: "));
        let sensor = self.sensor.map_or_else(String::new, |sensor| format!("{sensor}: "));
        format!("{line}{sensor}{}", self.message)
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{file}: ")?;
        }
        f.write_str(&self.without_file())
    }
}
