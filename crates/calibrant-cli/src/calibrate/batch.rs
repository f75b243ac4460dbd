//! Several recordings in one call. Each is calibrated by itself, and none stops the others.

use super::batch_page::batch_of;
use super::copies;
use super::job::Job;
use super::parallel::in_parallel;
use super::recorded::Recorded;
use super::sources::hashed_readings;
use crate::console;
use crate::diagnostics::{rules, tell, tell_in};
use crate::exit::Exit;
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::files::{FolderNameTaken, ResultsKept};
use calibrant::io::{SummaryRow, calibrations_json, write_atomically, write_summary};
use calibrant::report::{About, batch_sheet};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::PoisonError;

/// Calibrates from all recordings, then prints the outcome of each.
pub(super) fn run(job: &Job<'_>) -> calibrant::Result<Exit> {
    let arguments = job.arguments;
    let folders = folders(&arguments.recordings);
    for (folder, path) in folders.iter().zip(&arguments.recordings) {
        if *folder != stem(path) {
            let recording = Phrase(path.display().to_string());
            tell(FolderNameTaken { folder: Phrase(folder.clone()), recording });
        }
    }
    let bar = console::progress(folders.len() as u64, "calibrating");
    let files = in_parallel(folders.len(), |number| hashed_readings(&job.sources[number]));
    let copies = copies::of(&job.sources, &files);
    let recorded = in_parallel(folders.len(), |number| {
        let directory = arguments.output.join(&folders[number]);
        let source = &job.sources[number];
        let checked = match copies[number] {
            Some(copy) => Err(copies::refusal(copy)),
            None => job.check_records(source, || files[number].clone()),
        };
        let recorded = match checked {
            Ok(()) => Recorded::of(job, source, files[number].as_deref(), &directory),
            Err(error) => Recorded::refused(error),
        };
        bar.inc(1);
        recorded
    });
    bar.finish_and_clear();
    keep_earlier(job, &folders, &recorded);

    let exit = show(job, &folders, &recorded);
    let row = |((folder, path), recorded): ((&String, &PathBuf), &Recorded)| SummaryRow {
        file: folder.clone(),
        recording: path.display().to_string(),
        outcome: match &recorded.outcome {
            Ok(result) => Ok(result.finished.summary.clone()),
            Err(error) => Err(error.into()),
        },
    };
    let summary: Vec<SummaryRow> =
        folders.iter().zip(&arguments.recordings).zip(&recorded).map(row).collect();
    let path = arguments.output.join("summary.csv");
    write_summary(&path, &summary)?;
    let page_path = arguments.output.join("batch.html");
    let (batch, about) = (batch_of(job, &folders, &recorded), about(job));
    let sheet = batch_sheet(&batch, &about);
    write_atomically(&page_path, |out| out.write_all(sheet.html().as_bytes()))?;
    if arguments.json {
        let files: Vec<String> = arguments.recordings.iter().map(|path| path.display().to_string()).collect();
        let outcomes =
            summary.iter().zip(&recorded).map(|(row, recorded)| match (&row.outcome, &recorded.outcome) {
                (Err(failure), _) => Err(failure),
                (Ok(_), recorded) => Ok(recorded.as_ref().map_or("", |result| result.json.as_str())),
            });
        console::print_always(&calibrations_json(files.iter().map(String::as_str).zip(outcomes)));
    } else {
        console::sheet(&sheet);
        let failed = summary.iter().filter(|row| row.outcome.is_err()).count();
        console::print(&format!(
            "\n{} calibrated, {failed} failed: {}\n{}\n",
            summary.len() - failed,
            path.display(),
            page_path.display()
        ));
    }
    Ok(exit)
}

/// Prints what is told of each recording. Gives the exit status.
fn show(job: &Job<'_>, folders: &[String], recorded: &[Recorded]) -> Exit {
    let (arguments, mut exit) = (job.arguments, Exit::DONE);
    for ((path, folder), recorded) in arguments.recordings.iter().zip(folders).zip(recorded) {
        recorded.told().iter().for_each(|found| tell_in(found, Some(folder)));
        exit = exit.max(match &recorded.outcome {
            Ok(result) => rules().exit_of(result.finished.summary.verdict()),
            Err(error) => {
                console::error_in(error, path);
                Exit::of(error)
            }
        });
    }
    exit
}

/// Notes the results that stay as an earlier run wrote them, and says how many there are.
fn keep_earlier(job: &Job<'_>, folders: &[String], recorded: &[Recorded]) {
    if !job.arguments.resume {
        return;
    }
    let is_earlier = |recorded: &Recorded| recorded.outcome.as_ref().is_ok_and(|result| result.earlier);
    let earlier: Vec<&String> =
        folders.iter().zip(recorded).filter(|(_, of)| is_earlier(of)).map(|(folder, _)| folder).collect();
    tell(ResultsKept { kept: earlier.len(), recordings: recorded.len() });
    let files = |folder: &&String| {
        let directory = job.arguments.output.join(folder.as_str());
        ["calibration.json", "report.html", "resume.json"].map(|name| directory.join(name))
    };
    *job.arguments.kept.lock().unwrap_or_else(PoisonError::into_inner) =
        earlier.iter().flat_map(files).collect();
}

/// The head of the page.
fn about(job: &Job<'_>) -> About {
    let mut facts = vec![
        ("Experiment".to_owned(), job.arguments.experiment.display().to_string()),
        ("Recordings".to_owned(), job.arguments.recordings.len().to_string()),
    ];
    facts.extend(
        job.arguments.motion.as_ref().map(|motion| ("Motion".to_owned(), motion.display().to_string())),
    );
    facts.extend(
        job.arguments.accept.as_ref().map(|limits| ("Limits".to_owned(), limits.display().to_string())),
    );
    About {
        title: format!("Batch of {} sensors", job.arguments.recordings.len()),
        facts,
        program: format!("calibrant {}", env!("CARGO_PKG_VERSION")),
        ..About::default()
    }
}

/// A subfolder for each recording: the file's name without its ending. A number is added if the name repeats, or if another file of DIR has it.
/// Capitals do not count, since not every file system distinguishes them.
pub(super) fn folders(recordings: &[PathBuf]) -> Vec<String> {
    let mut seen = HashSet::from(["summary.csv", "batch.html"].map(str::to_owned));
    let mut taken: HashSet<String> = recordings.iter().map(|path| stem(path).to_lowercase()).collect();
    recordings
        .iter()
        .map(|path| {
            let stem = stem(path);
            if seen.insert(stem.to_lowercase()) {
                return stem;
            }
            let numbered = |k: usize| format!("{stem}-{k}");
            let free = (2..).map(numbered).find(|name| taken.insert(name.to_lowercase()));
            free.unwrap_or(stem)
        })
        .collect()
}

/// The name of a recording's file without its ending.
fn stem(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    // the file name `...csv` leaves `..`
    stem.filter(|stem| stem != "." && stem != "..").unwrap_or_else(|| "recording".into())
}
