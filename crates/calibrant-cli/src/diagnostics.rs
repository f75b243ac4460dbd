//! Which diagnostics are printed, and which set the exit status.

use crate::{Exit, console};
use calibrant::diagnostic::{Code, Diagnostic, Severity, Usability, Verdict};
use calibrant::io::{Told, ToldKind, nearest};
use calibrant::report::message;
use calibrant::session::Note;

/// The diagnostics that the user denies and allows.
#[derive(clap::Args)]
pub(crate) struct Rules {
    /// Exit with status 1 if this diagnostic occurs; `warnings` stands for all. `doubtful`: exit with status 5 where a result is doubtful. The results are written nevertheless. Repeatable. `calibrant explain` lists the codes.
    #[arg(long, value_name = "CODE", value_parser = denied)]
    deny: Vec<Denied>,
    /// Do not print this diagnostic, do not deny it, and do not count it for the verdict. JSON keeps it with the severity `allowed`. Repeatable.
    #[arg(long, value_name = "CODE", value_parser = code)]
    allow: Vec<Code>,
}

/// A diagnostic in its sentence.
pub(crate) fn told_of(diagnostic: &Diagnostic) -> Told {
    Told {
        kind: ToldKind::Diagnostic,
        code: Some(diagnostic.code()),
        file: String::new(),
        words: message(diagnostic),
    }
}

/// A note of the session in its sentence.
pub(crate) fn told_of_note(note: &Note) -> Told {
    let plain = |kind| Told { kind, code: None, file: String::new(), words: note.to_string() };
    match note {
        Note::Finding { file, finding } => Told {
            kind: ToldKind::Finding,
            code: Some(finding.code()),
            file: file.clone(),
            words: finding.to_string(),
        },
        Note::Warning(_) => plain(ToldKind::Warning),
        Note::Remark(_) => plain(ToldKind::Remark),
    }
}

/// A denied diagnostic, or all.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Denied {
    /// All warnings.
    Warnings,
    /// Doubtful results.
    Doubtful,
    /// One code.
    Code(Code),
}

impl Rules {
    /// The diagnostics that are allowed.
    pub(crate) fn allowed(&self) -> &[Code] {
        &self.allow
    }

    /// Prints what is told of a recording, but for codes that are allowed. Returns the exit status that denied codes set. `folder` stands before each, in place of the name of a file.
    pub(crate) fn show(&self, told: &[Told], folder: Option<&str>) -> Exit {
        let mut exit = Exit::DONE;
        for of in told.iter().filter(|of| of.code.is_none_or(|code| !self.allow.contains(&code))) {
            let place = match of.kind {
                ToldKind::Diagnostic | ToldKind::Finding => folder.unwrap_or(&of.file),
                ToldKind::Warning | ToldKind::Remark => "",
            };
            let text = if place.is_empty() { of.words.clone() } else { format!("{place}: {}", of.words) };
            let severity = of.code.map(Code::severity);
            match of.code {
                Some(code) if self.denies(code) => {
                    exit = Exit::DENIED;
                    console::denied(code.name(), &text);
                }
                _ => match of.kind {
                    ToldKind::Diagnostic if severity == Some(Severity::Error) => console::fault(&text),
                    ToldKind::Finding if severity < Some(Severity::Warning) => console::note(&text),
                    ToldKind::Diagnostic | ToldKind::Finding | ToldKind::Warning => console::warn(&text),
                    ToldKind::Remark => console::note(&text),
                },
            }
        }
        exit
    }

    /// The exit status that a verdict sets.
    pub(crate) fn exit_of(&self, verdict: &Verdict) -> Exit {
        match verdict.usability {
            Usability::Bad => Exit::BAD,
            Usability::Doubtful if self.deny.contains(&Denied::Doubtful) => Exit::BAD,
            _ => Exit::DONE,
        }
    }

    fn denies(&self, code: Code) -> bool {
        let is_warning = code.severity() >= Severity::Warning;
        self.deny.contains(&Denied::Code(code)) || is_warning && self.deny.contains(&Denied::Warnings)
    }
}

fn denied(text: &str) -> Result<Denied, String> {
    match text {
        "warnings" => Ok(Denied::Warnings),
        "doubtful" => Ok(Denied::Doubtful),
        _ => code(text).map(Denied::Code),
    }
}

fn code(text: &str) -> Result<Code, String> {
    code_named(text, std::iter::empty())
}

/// The diagnostic of this name. `others`: the names that are meant beside those of diagnostics.
pub(crate) fn code_named<'n>(text: &str, others: impl Iterator<Item = &'n str>) -> Result<Code, String> {
    let names = || Code::ALL.iter().map(|code| code.name());
    Code::parse(text).ok_or_else(|| match nearest(text, names().chain(others)) {
        Some(name) => format!("there is no such code; did you mean `{name}`?"),
        None => "there is no such code; `calibrant explain` lists them".into(),
    })
}
