//! Diagnostics in words, and how files state them.

use calibrant::diagnostic::Diagnostic;
use calibrant::io::DiagnosticWords;
use calibrant::report::message;

/// The sentence of each.
pub(crate) fn messages(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics.iter().map(message).collect()
}

/// As files state them, with no code allowed.
pub(crate) const WORDS: DiagnosticWords<'static> =
    DiagnosticWords { message: &message, allowed: &[], findings: &[], limits: &[] };
