//! Diagnostics as files state them: code, severity, subject, numbers and message.

use super::acceptance::{LimitFields, VerdictFields};
use calibrant_core::acceptance::CheckedLimit;
use calibrant_core::diagnostic::{Code, Diagnostic, Verdict};
use serde::{Serialize, Serializer};

/// How diagnostics are written: the words for each, the codes that somebody allows, and what counts for the verdict beside them.
///
/// The sentences are made by `calibrant_report::message`.
#[derive(Clone, Copy)]
pub struct DiagnosticWords<'a> {
    /// The sentence of a diagnostic.
    pub message: &'a (dyn Fn(&Diagnostic) -> String + Sync),
    /// Codes that are allowed; their severity is stated as `allowed`.
    pub allowed: &'a [Code],
    /// Codes of what a reader noticed in the recording. They count for the verdict.
    pub findings: &'a [Code],
    /// The limits that were checked.
    pub limits: &'a [CheckedLimit],
}

impl<'a> DiagnosticWords<'a> {
    /// These words, with no code allowed, and nothing beside the diagnostics.
    #[must_use]
    pub fn new(message: &'a (dyn Fn(&Diagnostic) -> String + Sync)) -> Self {
        Self { message, allowed: &[], findings: &[], limits: &[] }
    }
}

impl DiagnosticWords<'_> {
    /// The verdict on a result with these diagnostics.
    pub(super) fn verdict(&self, diagnostics: &[Diagnostic]) -> VerdictFields {
        let codes = diagnostics.iter().map(Diagnostic::code).chain(self.findings.iter().copied());
        VerdictFields::of(&Verdict::on(codes, self.allowed))
    }

    /// The limits that were checked.
    pub(super) fn limit_fields(&self) -> Vec<LimitFields> {
        self.limits.iter().map(LimitFields::of).collect()
    }
}

/// A diagnostic in a file.
#[derive(Serialize)]
pub(super) struct DiagnosticFields {
    code: &'static str,
    severity: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    subject: Option<String>,
    numbers: Numbers,
    message: String,
}

/// Numbers by name, in their order.
struct Numbers(Vec<(&'static str, f64)>);

impl Serialize for Numbers {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

impl DiagnosticFields {
    /// Each of them.
    pub(super) fn all(diagnostics: &[Diagnostic], words: &DiagnosticWords<'_>) -> Vec<Self> {
        diagnostics.iter().map(|diagnostic| Self::of(diagnostic, words)).collect()
    }

    fn of(diagnostic: &Diagnostic, words: &DiagnosticWords<'_>) -> Self {
        let code = diagnostic.code();
        Self {
            code: code.name(),
            severity: if words.allowed.contains(&code) { "allowed" } else { code.severity().name() },
            subject: diagnostic.subject(),
            numbers: Numbers(diagnostic.numbers()),
            message: (words.message)(diagnostic),
        }
    }
}
