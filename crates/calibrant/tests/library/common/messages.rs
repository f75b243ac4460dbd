//! Diagnostics in words, and how files state them.

use calibrant::diagnostic::Diagnostic;
use calibrant::io::Judgement;

/// The sentence of each.
pub(crate) fn messages(diagnostics: &[Diagnostic]) -> Vec<String> {
    diagnostics.iter().map(|found| found.message().to_owned()).collect()
}

/// As files state them, with no code allowed.
pub(crate) const WORDS: Judgement<'static> = Judgement { allowed: &[], findings: &[], limits: &[] };
