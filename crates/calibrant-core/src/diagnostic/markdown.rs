//! The table of codes as a page of the documentation.

use crate::diagnostic::code::Code;

/// The head of the page.
const HEAD: &str = "# Diagnostics\n
<!-- Made from crates/calibrant-core/src/diagnostic/code.rs: cargo run -p calibrant-core --example diagnostics > docs/diagnostics.md -->\n
calibrant prints a warning where a result may be wrong. Each warning has a code, which never changes.
`calibration.json` and `noise.json` list the warnings with code, severity, subject, numbers and message.
`calibrant calibrate --deny CODE` makes the exit status 1 where a code occurs, `--allow CODE` silences one.
";

/// The text of `docs/diagnostics.md`.
#[must_use]
pub fn table_as_markdown() -> String {
    let mut text = HEAD.to_owned();
    for code in Code::ALL {
        let entry = code.entry();
        text.push_str(&format!(
            "\n## {}\n\n{}\n\n- Severity: {}.\n- Decided: {}\n- What to do: {}\n",
            entry.name,
            entry.meaning,
            entry.severity.name(),
            entry.decided,
            entry.remedy
        ));
    }
    text
}
