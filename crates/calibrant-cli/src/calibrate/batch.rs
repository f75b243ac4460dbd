//! Several recordings in one call. Each is calibrated by itself, and none stops the others.

use super::job::Job;
use super::quality;
use super::worst_first::{Row, table_of};
use crate::{Exit, console};
use calibrant::diagnostic::{Diagnostic, Verdict};
use calibrant::io::{Summary, SummaryRow, calibrations_json, write_summary};
use calibrant::pipeline::{Note, Source};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The outcome of a recording.
struct Outcome {
    /// Notes and warnings about the recording.
    notes: Vec<Note>,
    calibrated: calibrant::Result<Calibrated>,
}

/// The part of a calibration that is kept for the tables.
struct Calibrated {
    verdict: Verdict,
    warnings: Vec<Diagnostic>,
    /// Cells of the table between the verdict and the codes.
    cells: Vec<String>,
    summary: Summary,
    /// calibration.json, if it is to be printed.
    json: Option<String>,
}

/// Calibrates from a recording and writes the results into this directory. Returns what is to be printed.
fn calibrate(job: &Job<'_>, source: &Source, directory: &Path) -> Outcome {
    let mut notes = Vec::new();
    let calibrated = job.run(source, directory, &mut notes).map(|outcome| Calibrated {
        verdict: outcome.verdict(),
        warnings: outcome.warnings().to_vec(),
        cells: quality::cells(&outcome.calibrated),
        summary: outcome.summary(),
        json: job.arguments.json.then(|| outcome.json()),
    });
    Outcome { notes, calibrated }
}

/// Calibrates from all recordings, then prints the outcome of each.
pub(super) fn run(job: &Job<'_>) -> calibrant::Result<Exit> {
    let (arguments, columns) = (job.arguments, quality::columns(job.experiment));
    let folders = folders(&arguments.recordings);
    for (folder, path) in folders.iter().zip(&arguments.recordings) {
        if *folder != stem(path) {
            console::note(&format!("{folder} is {}: the name is taken", path.display()));
        }
    }
    let bar = console::progress(folders.len() as u64, "calibrating");
    let outcomes = in_parallel(folders.len(), |number| {
        let outcome = calibrate(job, &job.sources[number], &arguments.output.join(&folders[number]));
        bar.inc(1);
        outcome
    });
    bar.finish_and_clear();

    let (mut exit, mut rows, mut texts, mut summary) = (Exit::DONE, Vec::new(), Vec::new(), Vec::new());
    for ((path, folder), outcome) in arguments.recordings.iter().zip(&folders).zip(outcomes) {
        exit = exit.max(arguments.rules.show_notes(&outcome.notes, Some(folder)));
        let outcome = match outcome.calibrated {
            Ok(calibrated) => {
                let Calibrated { verdict, warnings, cells, summary, json } = calibrated;
                exit = exit.max(arguments.rules.show(&warnings, &format!("{folder}: ")));
                exit = exit.max(arguments.rules.exit_of(&verdict));
                rows.push(Row::of_result(folder, &verdict, cells));
                texts.push(json.unwrap_or_default());
                Ok(summary)
            }
            Err(error) => {
                console::error_in(&error, path);
                exit = exit.max(Exit::of(&error));
                rows.push(Row::of_failure(folder, error.code().name(), columns.len()));
                texts.push(String::new());
                Err((&error).into())
            }
        };
        summary.push(SummaryRow { file: folder.clone(), recording: path.display().to_string(), outcome });
    }
    let path = arguments.output.join("summary.csv");
    write_summary(&path, &summary)?;
    if arguments.json {
        let files: Vec<String> = arguments.recordings.iter().map(|path| path.display().to_string()).collect();
        let outcomes = summary.iter().zip(&texts).map(|(row, text)| match &row.outcome {
            Ok(_) => Ok(text.as_str()),
            Err(failure) => Err(failure),
        });
        console::print(&calibrations_json(files.iter().map(String::as_str).zip(outcomes)));
    } else {
        console::print(&table_of(rows, columns));
        let failed = summary.iter().filter(|row| row.outcome.is_err()).count();
        console::print(&format!(
            "\n{} calibrated, {failed} failed: {}\n",
            summary.len() - failed,
            path.display()
        ));
    }
    Ok(exit)
}

/// All results in order, from one thread for each processor.
///
/// These are not threads of rayon. A thread of rayon that waits takes up other work, which could be a whole recording. The recordings would then
/// pile up in memory.
fn in_parallel<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let work = || {
        let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|number| *number < count);
        std::iter::from_fn(take).map(|number| (number, of(number))).collect::<Vec<_>>()
    };
    let mut results: Vec<(usize, T)> = std::thread::scope(|scope| {
        let threads: Vec<_> =
            (0..rayon::current_num_threads().min(count)).map(|_| scope.spawn(work)).collect();
        let results = threads.into_iter().flat_map(|thread| match thread.join() {
            Ok(results) => results,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        results.collect()
    });
    results.sort_by_key(|(number, _)| *number);
    results.into_iter().map(|(_, result)| result).collect()
}

/// A subfolder for each recording: the file's name without its ending. A number is added if the name repeats, or if another file of DIR has it.
/// Capitals do not count, since not every file system distinguishes them.
pub(super) fn folders(recordings: &[PathBuf]) -> Vec<String> {
    let mut seen = HashSet::from(["summary.csv".to_owned()]);
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
