//! What stands beside a result in its file: the codes that somebody allows, the verdict, and the limits.

use calibrant_core::acceptance::CheckedLimit;
use calibrant_core::diagnostic::{Code, Diagnostic, Verdict};

/// What judges a result beside its own diagnostics: the codes that somebody allows, and what counts for the verdict beside the diagnostics.
#[derive(Debug, Clone, Copy, Default)]
pub struct Judgement<'a> {
    /// Codes that are allowed; their severity is stated as `allowed`.
    pub allowed: &'a [Code],
    /// Codes of what a reader noticed in the recording. They count for the verdict.
    pub findings: &'a [Code],
    /// The limits that were checked.
    pub limits: &'a [CheckedLimit],
}

impl Judgement<'_> {
    /// The verdict on a result with these diagnostics.
    pub(crate) fn verdict(&self, diagnostics: &[Diagnostic]) -> Verdict {
        let codes = diagnostics.iter().map(Diagnostic::code).chain(self.findings.iter().copied());
        Verdict::on(codes, self.allowed)
    }

    /// The diagnostics, with the severity `allowed` where it applies.
    pub(crate) fn stated(&self, diagnostics: &[Diagnostic]) -> Vec<Diagnostic> {
        diagnostics.iter().map(|found| found.clone().allowed_by(self.allowed)).collect()
    }
}
