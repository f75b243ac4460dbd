//! The tables of codes as a page of the documentation.

use super::code::Code;
use crate::error::Refusal;

/// The head of the page.
const HEAD: &str = "# Diagnostics\n
<!-- Made from diagnostic/ and error/refusal.rs of crates/calibrant-core/src: cargo run -p calibrant-core --example diagnostics > docs/diagnostics.md -->\n
calibrant prints an error where a result must not be used, a warning where it may be wrong, and a note where there is something to know. Each has a code, which never changes.
The severest code is the verdict on a result: `bad` by an error, `doubtful` by a warning, otherwise `ok`.
`calibration.json` and `noise.json` list the warnings about the result with code, severity, subject, numbers and message.
`--deny CODE` makes the exit status of a command 1 where a code occurs. `--allow CODE` silences one, and takes it out of the verdict.
";

/// The head of the second part.
const REFUSALS: &str = "
## Refusals\n
calibrant prints an error where there is no result. Its code stands in brackets behind the message, and never changes.
`summary.csv` and the JSON of several recordings have it in the column `code`. The exit status says whether the experiment (2), the recording (3) or what they can determine (4) is at fault.
There are fewer codes than messages: errors with the same code ask for the same action.\n
| code | meaning | what to do |
|---|---|---|
";

/// The text of `docs/diagnostics.md`.
#[must_use]
pub fn table_as_markdown() -> String {
    let mut text = HEAD.to_owned();
    for code in Code::all() {
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
    text.push_str(REFUSALS);
    for code in Refusal::ALL {
        text.push_str(&format!("| `{}` | {} | {} |\n", code.name(), code.meaning(), code.remedy()));
    }
    text
}
