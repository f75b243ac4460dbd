//! Which diagnostics are printed, and which set the exit status.

use crate::{Exit, console};
use calibrant::diagnostic::{Code, Diagnostic, Severity, Usability, Verdict};
use calibrant::io::nearest;
use calibrant::pipeline::Note;
use calibrant::report::message;

/// The diagnostics that the user denies and allows.
#[derive(clap::Args)]
pub(crate) struct Rules {
    /// Exit with status 1 if this diagnostic occurs; `warnings` stands for all. `doubtful`: exit with status 5 where a result is doubtful. The results are written nevertheless. Repeatable. docs/diagnostics.md lists the codes.
    #[arg(long, value_name = "CODE", value_parser = denied)]
    deny: Vec<Denied>,
    /// Do not print this diagnostic, do not deny it, and do not count it for the verdict. JSON keeps it with the severity `allowed`. Repeatable.
    #[arg(long, value_name = "CODE", value_parser = code)]
    allow: Vec<Code>,
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

    /// Prints the diagnostics that are not allowed. Returns the exit status that they set. `prefix` stands before each.
    pub(crate) fn show(&self, diagnostics: &[Diagnostic], prefix: &str) -> Exit {
        let mut exit = Exit::DONE;
        for diagnostic in diagnostics.iter().filter(|found| !self.allow.contains(&found.code())) {
            let text = format!("{prefix}{}", message(diagnostic));
            if self.denies(diagnostic.code()) {
                exit = Exit::DENIED;
                console::denied(diagnostic.code().name(), &text);
            } else if diagnostic.severity() == Severity::Error {
                console::fault(&text);
            } else {
                console::warn(&text);
            }
        }
        exit
    }

    /// Prints the notes of a calibration, but for findings that are allowed, and gives the exit status that the findings set. `folder` replaces the name of the file.
    pub(crate) fn show_notes(&self, notes: &[Note], folder: Option<&str>) -> Exit {
        let mut exit = Exit::DONE;
        for note in notes {
            match note {
                Note::Finding { finding, .. } if self.allow.contains(&finding.code()) => {}
                Note::Finding { file, finding } => {
                    let file = folder.unwrap_or(file);
                    if self.denies(finding.code()) {
                        exit = Exit::DENIED;
                        console::denied(finding.code().name(), &format!("{file}: {finding}"));
                    } else {
                        console::finding(file, finding);
                    }
                }
                _ => console::noted(note),
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
    Code::parse(text).ok_or_else(|| match nearest(text, Code::ALL.iter().map(|code| code.name())) {
        Some(name) => format!("there is no such code; did you mean `{name}`?"),
        None => "there is no such code; docs/diagnostics.md lists them".into(),
    })
}
