//! Console output: tables on stdout, errors, notes and progress on stderr.

mod excerpt;
mod flags;
mod harmless;
mod manner;
mod width;

pub(crate) use flags::as_flags;
pub(crate) use harmless::in_one_line;
pub(crate) use manner::{Manner, color_among, leave_stdout, set as set_manner, shows_colour};

use calibrant::Error;
use calibrant::diagnostic::Severity;
use calibrant::report::{Sheet, wrapped};
use excerpt::Excerpt;
use harmless::harmless;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Prints what `json` makes, where it is asked for, or the text.
pub(crate) fn json_or(json: bool, as_json: impl FnOnce() -> String, text: impl FnOnce() -> String) {
    if json {
        print_always(&as_json());
    } else {
        print(&text());
    }
}

/// Prints a sheet to stdout as wide as the terminal is, or its JSON, where that is asked for.
#[cfg(feature = "records")]
pub(crate) fn sheet<'a>(json: bool, as_json: impl FnOnce() -> String, sheet: impl FnOnce() -> Sheet<'a>) {
    json_or(json, as_json, || sheet().text(width::get()));
}

/// Prints a result to stdout as wide as the terminal is: its sheet, a sentence on it, and the files that people open. Or its JSON, where that is asked for. The figures are files, where
/// that is asked for.
pub(crate) fn result(
    json: bool,
    as_json: impl FnOnce() -> String,
    sheet: &Sheet<'_>,
    sentence: Option<&str>,
    files: &[PathBuf],
) -> calibrant::Result<()> {
    crate::figures::write(sheet)?;
    json_or(json, as_json, || sheet.text(width::get()) + &sentence.map_or_else(String::new, paragraph));
    if !json && !files.is_empty() {
        let files: String = files.iter().map(|file| format!("\n{}", name(file))).collect();
        print_lines(&(files + "\n"));
    }
    Ok(())
}

/// Does it print sheets?
pub(crate) fn prints_sheets() -> bool {
    !manner::get().no_tables
}

/// Prints a result to stdout as people read it, unless `--quiet` hides it. Its lines fit the width of the terminal, and its minus signs can be copied into a
/// program.
pub(crate) fn print(text: &str) {
    print_lines(&wrapped(&text.replace('−', "-"), width::get()));
}

/// The same, with lines as long as they are: names of files, and commands to be copied.
pub(crate) fn print_lines(text: &str) {
    if prints_sheets() {
        print_always(text);
    }
}

/// The name of a file, in one line.
pub(crate) fn name(path: &Path) -> String {
    in_one_line(&path.display().to_string())
}

/// A paragraph, two characters from the margin.
pub(crate) fn paragraph(text: &str) -> String {
    calibrant::report::paragraph(text, width::get())
}

/// Prints what was asked for to stdout as it is, also with `--quiet`. A closed reader (`| head`) is not an error.
pub(crate) fn print_always(text: &str) {
    let mut out = std::io::stdout();
    match out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            say(ERROR, &format!("cannot write to standard output: {error}"));
            std::process::exit(2);
        }
        _ => {}
    }
}

/// How a line on stderr begins, with its colour.
type Label = (&'static str, &'static str);
/// An error: bold red.
const ERROR: Label = ("error:", "\u{1b}[1;31m");
/// A warning: bold yellow.
const WARNING: Label = ("warning:", "\u{1b}[1;33m");

/// A label, in colour where stderr shows it.
fn shown((label, colour): Label) -> String {
    if manner::get().in_colour { format!("{colour}{label}\u{1b}[0m") } else { label.to_owned() }
}

/// Writes a labelled text to stderr. Nobody can be told where that fails.
fn say(label: Label, text: &str) {
    let _ = writeln!(std::io::stderr(), "{} {text}", shown(label));
}

/// Prints a denied diagnostic to stderr.
pub(crate) fn denied(code: &str, text: &str) {
    say(ERROR, &format!("denied: {code}: {}", in_one_line(text)));
}

/// Prints a text of this severity to stderr: a note unless the console is quiet.
pub(crate) fn told(severity: Severity, text: &str) {
    let text = in_one_line(text);
    match severity {
        Severity::Allowed => {}
        Severity::Note if manner::get().quiet => {}
        Severity::Note => {
            let _ = writeln!(std::io::stderr(), "note: {text}");
        }
        Severity::Warning => say(WARNING, &text),
        Severity::Error => say(ERROR, &text),
    }
}

/// Prints an error to stderr, with the place in the file underlined where it is known.
pub(crate) fn error(error: &Error) {
    match error.input_error() {
        Some(input_error) if input_error.excerpt.is_some() => {
            let (text, range) = input_error.excerpt.clone().unwrap_or_default();
            let mut title = input_error.clone();
            (title.excerpt, title.help) = (None, String::new());
            let file = input_error.file.as_ref().map_or_else(|| "experiment".into(), |file| name(file));
            let (line, column) = (input_error.line.unwrap_or(1), input_error.column.unwrap_or(1));
            let shown = Excerpt {
                code: error.code().name(),
                message: &in_one_line(&title.to_string()),
                place: &format!("{file}:{line}:{column}"),
                text: &harmless::excerpt(&text),
                range,
                help: &in_one_line(&input_error.help),
            };
            say(ERROR, &shown.shown(width::get(), manner::get().in_colour));
        }
        _ => say(ERROR, &format!("{} [{}]", in_one_line(&error.to_string()), error.code().name())),
    }
}

/// Prints an error about this recording to stderr. An error without a file's name gets its name.
pub(crate) fn error_in(found: &Error, recording: &Path) {
    if found.is_not_identifiable() {
        let text = in_one_line(&format!("{}: {found}", recording.display()));
        say(ERROR, &format!("{text} [{}]", found.code().name()));
    } else {
        error(found);
    }
}

/// A count on stderr, of work whose length is not known. It is invisible if stderr is not a terminal, or the console quiet.
pub(crate) fn spinner(what: &str) -> ProgressBar {
    let bar = if manner::get().quiet { ProgressBar::hidden() } else { ProgressBar::new_spinner() };
    if let Ok(style) = ProgressStyle::with_template(&format!("{{spinner}} {{human_pos}} {what} {{per_sec}}"))
    {
        bar.set_style(style);
    }
    bar
}

/// A progress bar on stderr. It is invisible if stderr is not a terminal, or the console quiet.
pub(crate) fn progress(length: u64, what: &str) -> ProgressBar {
    let bar = if manner::get().quiet { ProgressBar::hidden() } else { ProgressBar::new(length) };
    let template =
        format!("{{spinner}} {what} [{{bar:30}}] {{human_pos}}/{{human_len}} {{per_sec}} {{eta}} {{msg}}");
    if let Ok(style) = ProgressStyle::with_template(&template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}
