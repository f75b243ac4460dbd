//! `calibrant calibrate` with one recording: calibrates, writes the results, prints diagnostics and tables, and returns the exit status.

use super::arguments::Arguments;
use crate::console;
use crate::diagnostics::{rules, tell_all};
use crate::exit::Exit;
use calibrant::Error;
use calibrant::batch::Batch;
use calibrant::diagnostic::Severity;
use calibrant::io::write_text;
use calibrant::session::Source;

/// Calibrates from the recording and shows the result.
pub(super) fn run(arguments: &Arguments, batch: &Batch, source: &Source) -> Exit {
    let mut notes = Vec::new();
    let outcome = batch.calibrate(source, &mut notes);
    tell_all(&notes);
    match outcome {
        Ok(outcome) => {
            tell_all(outcome.warnings());
            // where they cannot be written, the result is shown all the same
            let written = arguments.residuals.as_ref().map(|path| outcome.residuals().write(path));
            let residuals = arguments.residuals.iter().filter(|_| matches!(written, Some(Ok(()))));
            let files: Vec<_> = std::iter::once(arguments.main_result()).chain(residuals.cloned()).collect();
            let shown = console::result(arguments.json, || outcome.json(), &outcome.sheet(), None, &files);
            match written.unwrap_or(Ok(())).and(shown) {
                Err(error) => {
                    console::error(&error);
                    Exit::of(&error)
                }
                Ok(()) => rules().exit_of(&outcome.verdict()),
            }
        }
        Err(error) if error.is_not_identifiable() => match in_one_pose(arguments, batch, source) {
            Some(exit) => exit,
            None => told(arguments, batch, source, &error),
        },
        Err(error) => told(arguments, batch, source, &error),
    }
}

/// Biases over temperature, where the recording is in one pose. `None` where it is not.
fn in_one_pose(arguments: &Arguments, batch: &Batch, source: &Source) -> Option<Exit> {
    let found = batch.session().one_pose(source).transpose()?;
    let shown = found.and_then(|found| {
        tell_all(&found.fitted.warnings);
        found.write(&arguments.output, !arguments.no_report)?;
        console::result(arguments.json, || found.json(), &found.sheet(), None, &[arguments.main_result()])?;
        Ok(rules().exit_of(&found.verdict()))
    });
    Some(shown.unwrap_or_else(|error| {
        console::error(&error);
        Exit::of(&error)
    }))
}

/// Says why there is no calibration.
fn told(arguments: &Arguments, batch: &Batch, source: &Source, error: &Error) -> Exit {
    match batch.session().experiment().imu {
        Some(_) => console::error(error),
        None => console::error_in(error, source.path()),
    }
    write_page(arguments, batch, source, error);
    Exit::of(error)
}

/// Writes the page about the error, where there is a recording to show, and says so.
fn write_page(arguments: &Arguments, batch: &Batch, source: &Source, error: &Error) {
    let page = (!arguments.no_report).then(|| batch.session().failure_html(source, error)).flatten();
    let path = arguments.output.join("report.html");
    if let Some(page) = page
        && write_text(&path, &page).is_ok()
    {
        console::told(
            Severity::Note,
            &format!("the recording, and what is at rest in it: {}", console::name(&path)),
        );
    }
}
