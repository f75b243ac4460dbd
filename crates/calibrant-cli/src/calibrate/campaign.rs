//! `calibrant calibrate` of a campaign over temperature: each soak by itself, then one calibration over all of them.

use super::arguments::Arguments;
use super::job;
use crate::console;
use crate::diagnostics::{rules, tell_all, tell_in};
use crate::exit::Exit;
use calibrant::Error;
use calibrant::batch::{Batch, BatchResults, BatchRow, folder_names};
use calibrant::diagnostic::fit::{FewDegreesOfFreedom, NothingToCheck};
use calibrant::diagnostic::samples::TemperatureExtrapolated;
use calibrant::diagnostic::{Check, Severity};
use calibrant::error::{InputError, Refusal};
use calibrant::io::{Experiment, write_summary};
use calibrant::progress::Progress;
use calibrant::session::{Session, SessionOptions};
use calibrant::{CampaignCalibration, calibrate_soaks, is_ramp};
use std::collections::HashSet;
use std::path::Path;

/// Are these the soaks of a campaign?
pub(super) fn is_one(arguments: &Arguments, experiment: &Experiment) -> bool {
    let several = arguments.recordings.len() > 1 && !arguments.together;
    experiment.campaign_section().is_some() && (several || are_calibrated(arguments))
}

/// Is the one recording of the batch a ramp of a campaign? `batch` is of one soak.
pub(super) fn is_of_ramp(batch: &Batch) -> bool {
    // what cannot be read is told where it is calibrated
    matches!(batch.sources(), [source] if is_ramp(batch.session(), source).unwrap_or(false))
}

/// Are the soaks calibrated already? Then their calibrations are given in place of the recordings.
pub(super) fn are_calibrated(arguments: &Arguments) -> bool {
    arguments.recordings.iter().all(|path| is_calibration(path))
}

fn is_calibration(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "json")
}

/// Refuses what is of one recording, and calibrations among recordings.
fn refuse_other_options(arguments: &Arguments) -> calibrant::Result<()> {
    let given = [
        ("--folds", arguments.folds.is_some()),
        ("--residuals", arguments.residuals.is_some()),
        ("--records", arguments.records.is_some()),
        ("--accept", arguments.accept.is_some()),
    ];
    let refused = |message: String, help: &str| {
        Err(Error::experiment(InputError::new(Refusal::OptionsContradict, message, help)))
    };
    if let Some((option, _)) = given.iter().find(|(_, given)| *given) {
        let help = "leave it away; the report tells how the others predict each soak, and --validate tries another recording";
        return refused(format!("{option} is not for a campaign over temperature"), help);
    }
    let same = |one: &Path, other: &Path| {
        one.canonicalize().is_ok_and(|one| other.canonicalize().is_ok_and(|other| one == other))
    };
    if let Some(held_out) = arguments.validate.as_ref().filter(|path| !path.is_file()) {
        // before an hour of work
        let error =
            InputError::new(Refusal::FileUnreadable, "no such file", "give the recording to validate on");
        return Err(Error::recording(error.in_file(held_out)));
    }
    if let Some(held_out) = &arguments.validate
        && arguments.recordings.iter().any(|recording| same(recording, held_out))
    {
        let help = "leave it out of the soaks, or give another recording of the sensor";
        return refused(format!("--validate {}: it is among the soaks", held_out.display()), help);
    }
    if !are_calibrated(arguments) && arguments.recordings.iter().any(|path| is_calibration(path)) {
        let help = "give the recordings of all soaks, or the calibration.json of each";
        return refused("some soaks are recordings, and some are calibrations".to_owned(), help);
    }
    Ok(())
}

pub(super) fn run(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<Exit> {
    refuse_other_options(arguments)?;
    let (soaks, mut exit) = if are_calibrated(arguments) {
        let names = folder_names(&arguments.recordings);
        let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string());
        (names.into_iter().zip(arguments.recordings.iter().map(|path| read(path))).collect(), Exit::DONE)
    } else {
        each(arguments, experiment)?
    };
    let mut notes = Vec::new();
    let found = CampaignCalibration::of_soaks(experiment, soaks, rules().allowed(), &mut notes);
    tell_all(&notes);
    let mut found = found?;
    let options = job::options(arguments)?;
    if let Some(held_out) = options.validate.clone() {
        found = found.validate(&Session::with(experiment.of_one_soak()?, options)?, &held_out)?;
    }
    tell_all(&found.fitted.warnings);
    found.write(&arguments.output, !arguments.no_report)?;
    console::result(arguments.json, || found.json(), &found.sheet(), None, &[arguments.main_result()])?;
    exit = exit.max(rules().exit_of(&found.verdict()));
    Ok(exit)
}

/// A soak's name, and the text of its calibration or why there is none.
type Soaks = Vec<(String, std::result::Result<String, String>)>;

/// Calibrates each soak into a folder of its own.
fn each(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<(Soaks, Exit)> {
    let of_one = experiment.of_one_soak()?;
    // what validates is for all soaks together
    let options = SessionOptions { validate: None, ..job::options(arguments)? };
    let batch = job::batch_with(options, arguments, &of_one)?;
    let bar = console::progress(arguments.recordings.len() as u64, "calibrating soaks");
    let shown = bar.clone();
    let mut results: BatchResults = batch.run(&Progress::to(move |step| shown.set_position(step.done)));
    bar.finish_and_clear();
    // twice the same is a mistake, and the soak would be lost
    let is_repeated = |error: &Error| error.code() == Refusal::RecordingRepeated;
    let repeated = results.rows.iter().position(|row| row.outcome.as_ref().is_err_and(is_repeated));
    if let Some(Err(error)) = repeated.map(|number| results.rows.swap_remove(number).outcome) {
        return Err(error);
    }
    let (rows, notes) = calibrate_soaks(experiment, batch, results.rows, &Progress::default())?;
    let results = BatchResults { rows, ..results };
    tell_all(&notes);
    let (mut exit, mut open_is_told, mut notes) = (Exit::DONE, false, HashSet::new());
    for row in &results.rows {
        // what checks a soak are the others
        let of_one = [NothingToCheck::CODE, FewDegreesOfFreedom::CODE, TemperatureExtrapolated::CODE];
        let told = row.told().iter().filter(|found| !of_one.contains(&found.code()));
        // what is said of one soak in the same words need not be said of all
        let told = told.filter(|found| found.severity() > Severity::Note || notes.insert(found.to_string()));
        told.for_each(|found| tell_in(found, Some(&row.folder)));
        if let Err(error) = &row.outcome {
            // one of many that leave parameters open is enough here: all are named as left out
            if !matches!(error, Error::NotIdentifiable(_)) || !std::mem::replace(&mut open_is_told, true) {
                console::error_in(error, &row.recording);
            }
            exit = exit.max(Exit::of(error));
        }
    }
    write_summary(&arguments.output.join("summary.csv"), &results.summary())?;
    let soak = |row: BatchRow| {
        let text = row.outcome.map(|result| result.json).map_err(|error| error.to_string());
        (row.folder, text)
    };
    Ok((results.rows.into_iter().map(soak).collect(), exit))
}
