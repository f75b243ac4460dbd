//! Several recordings in one call: prints what became of each, and writes the table and the page of all.

use super::arguments::Arguments;
use crate::console;
use crate::diagnostics::{rules, tell, tell_all, tell_in};
use crate::exit::Exit;
use calibrant::batch::{Batch, BatchResults, RESULT_FILES, folder_names, own_names};
use calibrant::diagnostic::design::SeriesInterrupted;
use calibrant::diagnostic::files::{FolderNameTaken, ResultsKept};
use calibrant::diagnostic::{Diagnostic, Phrase};
use calibrant::io::{write_summary, write_text};
use calibrant::progress::Progress;
use calibrant::report::batch_sheet;
use std::sync::PoisonError;

/// Calibrates from all recordings, then prints the outcome of each.
pub(super) fn run(arguments: &Arguments, batch: &Batch) -> calibrant::Result<Exit> {
    let own = own_names(&arguments.recordings).into_iter().zip(&arguments.recordings);
    for (folder, (name, path)) in folder_names(&arguments.recordings).into_iter().zip(own) {
        if folder != name {
            let recording = Phrase(path.display().to_string());
            tell(FolderNameTaken { folder: Phrase(folder), recording });
        }
    }
    let bar = console::progress(arguments.recordings.len() as u64, "calibrating");
    let shown = bar.clone();
    let results = batch.run(&Progress::to(move |step| shown.set_position(step.done)));
    bar.finish_and_clear();
    keep_earlier(arguments, &results);
    let exit = show(&results);
    let (finished, all) = (results.rows.len() - results.interrupted(), results.rows.len());
    let interrupted = SeriesInterrupted { series: "batch", items: "recordings", finished, all };
    let interrupted = (finished < all).then(|| Diagnostic::from(interrupted));
    tell_all(&interrupted);
    let [summary, page_path] = ["summary.csv", "batch.html"].map(|name| arguments.output.join(name));
    write_summary(&summary, &results.summary())?;
    let (page, mut about) = (batch.page(&results), batch.about());
    about.facts.extend(arguments.accept.iter().map(|file| ("Limits".to_owned(), file.display().to_string())));
    about.findings.extend(interrupted.iter().map(Diagnostic::without_file));
    let sheet = batch_sheet(&page, &about);
    write_text(&page_path, &sheet.html())?;
    console::result(arguments.json, || results.json(), &sheet, None, &[])?;
    if !arguments.json {
        let failed = results.failed();
        console::print(&format!(
            "\n{} calibrated, {failed} failed: {}\n{}\n",
            finished - failed,
            console::name(&summary),
            console::name(&page_path)
        ));
    }
    Ok(exit)
}

/// Prints what is told of each recording. Gives the exit status.
fn show(results: &BatchResults) -> Exit {
    let mut exit = Exit::DONE;
    for row in results.rows.iter().filter(|row| !row.is_interrupted()) {
        row.told().iter().for_each(|found| tell_in(found, Some(&row.folder)));
        exit = exit.max(match &row.outcome {
            Ok(result) => rules().exit_of(result.finished.summary.verdict()),
            Err(error) => {
                console::error_in(error, &row.recording);
                Exit::of(error)
            }
        });
    }
    exit
}

/// Notes the results that stay as an earlier run wrote them, and says how many there are.
fn keep_earlier(arguments: &Arguments, results: &BatchResults) {
    if !arguments.resume {
        return;
    }
    let earlier: Vec<_> = results.rows.iter().filter(|row| row.is_earlier()).collect();
    tell(ResultsKept { kept: earlier.len(), recordings: results.rows.len() });
    let files =
        earlier.iter().flat_map(|row| RESULT_FILES.map(|name| arguments.output.join(&row.folder).join(name)));
    *arguments.kept.lock().unwrap_or_else(PoisonError::into_inner) = files.collect();
}
