//! What codes mean.

use calibrant::diagnostic::Code;
use calibrant::error::{Refusal, with_options_worded};
use pyo3::prelude::*;

/// Code, severity, meaning, how it is decided, what to do.
type Explained = (&'static str, &'static str, String, Option<String>, String);

/// All codes: those of diagnostics, then those of errors.
#[pyfunction]
pub(crate) fn explained() -> Vec<Explained> {
    crate::wording::set();
    let worded = |text: &str| with_options_worded(text.to_owned());
    let diagnostics = Code::all().map(|code| {
        let entry = code.entry();
        let (meaning, remedy) = (worded(entry.meaning), worded(entry.remedy));
        (code.name(), code.severity().name(), meaning, Some(worded(entry.decided)), remedy)
    });
    let errors = Refusal::ALL
        .iter()
        .map(|code| (code.name(), "error", worded(code.meaning()), None, worded(code.remedy())));
    diagnostics.chain(errors).collect()
}
