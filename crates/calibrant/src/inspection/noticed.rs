//! What was noticed.

use calibrant_core::diagnostic::{Diagnostic, Severity};
use calibrant_report::Section;

/// What was noticed, each with its severity and its code, without what is allowed. `in_files`: are there several files, whose names stand before?
pub(super) fn noticed(findings: &[Diagnostic], in_files: bool) -> Section<'static> {
    let line = |found: &Diagnostic| {
        let text = if in_files { found.to_string() } else { found.without_file() };
        format!("{}: {text} [{}]", found.severity().name(), found.code())
    };
    let is_shown = |found: &&Diagnostic| found.severity() > Severity::Allowed;
    let mut section = Section::new("Noticed");
    section.list(findings.iter().filter(is_shown).map(line).collect());
    section
}
