//! Diagnostics as files state them: code, severity, subject, numbers and message.

use calibrant_core::acceptance::CheckedLimit;
use calibrant_core::diagnostic::{Code, Diagnostic, Verdict};
use calibrant_core::json::{if_some, named};
use calibrant_core::json_object;

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

    /// The verdict on a result with these diagnostics.
    pub(super) fn verdict(&self, diagnostics: &[Diagnostic]) -> Verdict {
        let codes = diagnostics.iter().map(Diagnostic::code).chain(self.findings.iter().copied());
        Verdict::on(codes, self.allowed)
    }

    /// Each diagnostic with its words.
    pub(super) fn all<'d>(&'d self, diagnostics: &'d [Diagnostic]) -> Vec<WordedDiagnostic<'d>> {
        diagnostics.iter().map(|diagnostic| WordedDiagnostic { diagnostic, words: self }).collect()
    }
}

/// A diagnostic in a file.
pub(super) struct WordedDiagnostic<'a> {
    diagnostic: &'a Diagnostic,
    words: &'a DiagnosticWords<'a>,
}

json_object! {
    /// What the user should know.
    WordedDiagnostic<'_> as of {
        code: of.diagnostic.code(),
        /// `note`, `warning` or `error`; `allowed` where the user allows the code.
        severity: of.severity(),
        subject: if_some(of.diagnostic.subject()),
        /// By their names.
        numbers: Numbers(of.diagnostic.numbers()),
        message: (of.words.message)(of.diagnostic),
    }
}

impl WordedDiagnostic<'_> {
    fn severity(&self) -> &'static str {
        let code = self.diagnostic.code();
        if self.words.allowed.contains(&code) { "allowed" } else { code.severity().name() }
    }
}

/// Numbers by name, in their order.
struct Numbers(Vec<(&'static str, f64)>);

json_object! {
    Numbers as numbers {
        by_name: named(numbers.0.iter().copied()),
    }
}
