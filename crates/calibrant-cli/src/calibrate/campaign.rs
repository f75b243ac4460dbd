//! `calibrant calibrate` of a campaign over temperature: each soak by itself, then one calibration over all of them.

use super::arguments::Arguments;
use super::job;
use crate::console;
use crate::diagnostics::{rules, tell_all, tell_in};
use crate::exit::Exit;
use calibrant::CampaignCalibration;
use calibrant::batch::{BatchResults, folder_names};
use calibrant::io::{Experiment, write_summary};
use calibrant::progress::Progress;
use std::path::Path;

/// Are these the soaks of a campaign?
pub(super) fn is_one(arguments: &Arguments, experiment: &Experiment) -> bool {
    let several = arguments.recordings.len() > 1 && !arguments.together;
    experiment.campaign_section().is_some() && (several || are_calibrated(arguments))
}

/// Are the soaks calibrated already? Then their calibrations are given in place of the recordings.
pub(super) fn are_calibrated(arguments: &Arguments) -> bool {
    arguments.recordings.iter().all(|path| path.extension().is_some_and(|ending| ending == "json"))
}

pub(super) fn run(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<Exit> {
    let (soaks, mut exit) = if are_calibrated(arguments) {
        let names = folder_names(&arguments.recordings);
        let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string());
        (names.into_iter().zip(arguments.recordings.iter().map(|path| read(path))).collect(), Exit::DONE)
    } else {
        each(arguments, experiment)?
    };
    let found = CampaignCalibration::of_soaks(experiment, soaks, rules().allowed())?;
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
    let batch = job::batch(arguments, &of_one)?;
    let bar = console::progress(arguments.recordings.len() as u64, "calibrating soaks");
    let shown = bar.clone();
    let results: BatchResults = batch.run(&Progress::to(move |step| shown.set_position(step.done)));
    bar.finish_and_clear();
    let mut exit = Exit::DONE;
    for row in &results.rows {
        row.told().iter().for_each(|found| tell_in(found, Some(&row.folder)));
        if let Err(error) = &row.outcome {
            console::error_in(error, &row.recording);
            exit = exit.max(Exit::of(error));
        }
    }
    write_summary(&arguments.output.join("summary.csv"), &results.summary())?;
    let soak = |row: calibrant::batch::BatchRow| {
        let text = row.outcome.map(|result| result.json).map_err(|error| error.to_string());
        (row.folder, text)
    };
    Ok((results.rows.into_iter().map(soak).collect(), exit))
}
