//! Which diagnostics are printed, and which set the exit status.

use crate::console;
use crate::exit::Exit;
use calibrant::diagnostic::{Code, Diagnostic, Severity, Usability, Verdict};
use calibrant::io::nearest;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// The diagnostics that the user denies and allows.
#[derive(clap::Args, Debug, Clone, Default)]
pub(crate) struct Rules {
    /// Exit with status 1 if this diagnostic occurs; `warnings` stands for all. `doubtful`: exit with status 5 where a result is doubtful. The results are written nevertheless. Repeatable. `calibrant explain` lists the codes.
    #[arg(long, global = true, value_name = "CODE", value_parser = denied)]
    deny: Vec<Denied>,
    /// Do not print this diagnostic, do not deny it, and do not count it for the verdict. JSON keeps it with the severity `allowed`. Repeatable.
    #[arg(long, global = true, value_name = "CODE", value_parser = code)]
    allow: Vec<Code>,
}

/// A denied diagnostic, or all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Denied {
    /// All warnings.
    Warnings,
    /// Doubtful results.
    Doubtful,
    /// One code.
    Code(Code),
}

static RULES: OnceLock<Rules> = OnceLock::new();
static IS_DENIED: AtomicBool = AtomicBool::new(false);

/// The rules of this run.
pub(crate) fn rules() -> &'static Rules {
    RULES.get_or_init(Rules::default)
}

/// Prints a diagnostic, unless its code is allowed. A denied code sets the exit status of the program.
pub(crate) fn tell(found: impl Into<Diagnostic>) {
    let found = found.into();
    tell_in(&found, None);
}

/// The same; a folder stands before it, in place of the name of a file.
pub(crate) fn tell_in(found: &Diagnostic, folder: Option<&str>) {
    let (rules, code) = (rules(), found.code());
    if rules.allow.contains(&code) {
        return;
    }
    let text = match folder {
        Some(folder) => format!("{folder}: {}", found.without_file()),
        None => found.to_string(),
    };
    if rules.denies(code) {
        IS_DENIED.store(true, Ordering::Relaxed);
        console::denied(code.name(), &text);
    } else {
        console::told(found.severity(), &format!("{text} [{code}]"));
    }
}

/// Prints each of them.
pub(crate) fn tell_all<'d>(found: impl IntoIterator<Item = &'d Diagnostic>) {
    found.into_iter().for_each(|found| tell_in(found, None));
}

/// Marks those that are allowed. Prints those that are denied, and warnings where no sheet lists them.
pub(crate) fn judge(findings: &mut [Diagnostic], json: bool) {
    let is_listed = console::prints_sheets() && !json;
    for found in findings {
        *found = found.clone().allowed_by(rules().allowed());
        if rules().denies(found.code()) || found.is_warning() && !is_listed {
            tell_in(found, None);
        }
    }
}

impl Rules {
    /// Makes these the rules of this run.
    pub(crate) fn set(self) {
        // they are set once
        let _ = RULES.set(self);
    }

    /// The exit status that denied codes have set.
    pub(crate) fn exit() -> Exit {
        if IS_DENIED.load(Ordering::Relaxed) { Exit::DENIED } else { Exit::DONE }
    }

    /// The diagnostics that are allowed.
    pub(crate) fn allowed(&self) -> &[Code] {
        &self.allow
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
    let names = || Code::all().map(|code| code.name());
    Code::parse(text).ok_or_else(|| match nearest(text, names().chain(others)) {
        Some(name) => format!("there is no such code; did you mean `{name}`?"),
        None => "there is no such code; `calibrant explain` lists them".into(),
    })
}
