//! `calibrant calibrate` with one recording: calibrates, writes the results, prints diagnostics and tables, and returns the exit status.

use super::job::Job;
use super::sources::hashed_readings;
use crate::diagnostics::{told_of, told_of_note};
use crate::{Exit, console};
use calibrant::session::{Outcome, Source};

/// Calibrates from the recording and shows the result.
pub(super) fn run(job: &Job<'_>, source: &Source) -> Exit {
    let directory = &job.arguments.output;
    let mut notes = Vec::new();
    let outcome = job
        .check_records(source, || hashed_readings(source))
        .and_then(|()| job.run(source, directory, &mut notes));
    let denied = job.arguments.rules.show(&notes.iter().map(told_of_note).collect::<Vec<_>>(), None);
    match outcome {
        Ok(outcome) => show(job, &outcome).max(denied).max(job.arguments.rules.exit_of(&outcome.verdict())),
        Err(error) => {
            match job.experiment.imu {
                Some(_) => console::error(&error),
                None => console::error_in(&error, source.recording.path()),
            }
            Exit::of(&error)
        }
    }
}

/// Prints the diagnostics, then the tables or calibration.json. Gives the exit status that denied diagnostics set.
fn show(job: &Job<'_>, outcome: &Outcome) -> Exit {
    let told: Vec<_> = outcome.warnings().iter().map(told_of).collect();
    let exit = job.arguments.rules.show(&told, None);
    if job.arguments.json {
        console::print_always(&outcome.json());
        return exit;
    }
    console::sheet(&outcome.sheet());
    console::print(&format!("\n{}\n", job.arguments.main_result().display()));
    exit
}
