//! A calibration over temperature, from recordings or from the calibrations of soaks.

use crate::experiment::Experiment;
use calibrant::batch::{Batch, BatchOptions, BatchRow};
use calibrant::diagnostic::Diagnostic;
use calibrant::progress::Progress;
use calibrant::session::{Session, SessionOptions, Source};
use calibrant::{CampaignCalibration, Error, Result, calibrate_soaks};

/// A soak's name, and the text of its calibration or why there is none.
type Soak = (String, std::result::Result<String, String>);
/// The calibration, and what was noticed beside it.
type Found = (CampaignCalibration, Vec<Diagnostic>);

/// Calibrates each recording by itself, a ramp in pieces, then over temperature.
pub(crate) fn of_recordings(
    experiment: &Experiment,
    sources: Vec<Source>,
    options: SessionOptions,
    held_out: Option<&Source>,
    progress: &Progress,
) -> Result<Found> {
    let of_one = experiment.read.of_one_soak().map_err(Experiment::placed(&experiment.file))?;
    let session = Session::with(of_one, options.clone())?;
    let batch = Batch::new(session, sources, BatchOptions { keep_json: true, ..BatchOptions::default() })?;
    let rows = batch.run(progress).rows;
    let (mut rows, notes) = calibrate_soaks(&experiment.read, batch, rows, progress)?;
    // where none can be used, the first says why
    if rows.iter().all(|row| row.outcome.is_err()) && !rows.is_empty() {
        let BatchRow { outcome, recording, .. } = rows.swap_remove(0);
        outcome.map_err(|error| error.in_recording(&recording))?;
    }
    let soak = |row: BatchRow| {
        let text = row.outcome.map(|result| result.json).map_err(|error| error.to_string());
        (row.folder, text)
    };
    let soaks = rows.into_iter().map(soak).collect();
    over_temperature(experiment, soaks, options, (held_out, notes))
}

/// One calibration over these soaks.
pub(crate) fn over_temperature(
    experiment: &Experiment,
    soaks: Vec<Soak>,
    options: SessionOptions,
    (held_out, mut notes): (Option<&Source>, Vec<Diagnostic>),
) -> Result<Found> {
    let found = CampaignCalibration::of_soaks(&experiment.read, soaks, &options.allowed, &mut notes);
    let mut found =
        found.map_err(|error| with_reason(error, &notes)).map_err(Experiment::placed(&experiment.file))?;
    if let Some(held_out) = held_out {
        let of_one = experiment.read.of_one_soak().map_err(Experiment::placed(&experiment.file))?;
        found = found.validate(&Session::with(of_one, options)?, held_out)?;
    }
    Ok((found, notes))
}

/// The error with why the first soak was left out: nobody sees the notes of what failed.
fn with_reason(error: Error, notes: &[Diagnostic]) -> Error {
    match (error, notes.first()) {
        (Error::Recording(mut of), Some(note)) => {
            of.message = format!("{}: {note}", of.message);
            Error::Recording(of)
        }
        (error, _) => error,
    }
}
