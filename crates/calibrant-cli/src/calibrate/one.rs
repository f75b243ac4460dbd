//! `calibrant calibrate` with one recording: calibrates, writes the results, prints diagnostics and tables, and returns the exit status.

use super::job::Job;
use super::sources::hashed_readings;
use crate::console;
use crate::diagnostics::{rules, tell_all};
use crate::exit::Exit;
use calibrant::session::{Outcome, Source};

/// Calibrates from the recording and shows the result.
pub(super) fn run(job: &Job<'_>, source: &Source) -> Exit {
    let directory = &job.arguments.output;
    let mut notes = Vec::new();
    let outcome = job
        .check_records(source, || hashed_readings(source))
        .and_then(|()| job.run(source, directory, &mut notes))
        .and_then(|outcome| {
            job.arguments.residuals.as_ref().map_or(Ok(()), |path| outcome.residuals().write(path))?;
            Ok(outcome)
        });
    tell_all(&notes);
    match outcome {
        Ok(outcome) => {
            show(job, &outcome);
            rules().exit_of(&outcome.verdict())
        }
        Err(error) => {
            match job.experiment.imu {
                Some(_) => console::error(&error),
                None => console::error_in(&error, source.recording.path()),
            }
            Exit::of(&error)
        }
    }
}

/// Prints the diagnostics, then the tables or calibration.json.
fn show(job: &Job<'_>, outcome: &Outcome) {
    tell_all(outcome.warnings());
    if job.arguments.json {
        console::print_always(&outcome.json());
        return;
    }
    console::sheet(&outcome.sheet());
    let files = std::iter::once(job.arguments.main_result()).chain(job.arguments.residuals.clone());
    let files: String = files.map(|path| format!("{}\n", path.display())).collect();
    console::print(&format!("\n{files}"));
}
