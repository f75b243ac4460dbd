//! `calibrant compare`: compares two calibrations, whatever their conventions.

use crate::calibration_file::{Reading, in_words};
use crate::console;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::estimate::{Comparison, Place};
use calibrant::io::{ComparisonFile, to_json};
use calibrant::report::comparison_sheet;
use std::path::PathBuf;

/// Compare two calibrations by quantities that do not depend on the true frame: gains, angles between axes, biases, g-sensitivity.
///
/// Each file is in a format that `calibrant convert` reads, or the truth.json of a simulation, whose values are exact. With a covariance, the
/// difference is also given in standard deviations, and as one χ² of all parameters.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The first calibration.
    a: PathBuf,
    /// The second.
    b: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Both were made at one place: what is not known of it, such as its gravity, is one error of both (default: by the stations that the files name).
    #[arg(long)]
    one_place: bool,
    /// Print JSON instead of the table.
    #[arg(long)]
    json: bool,
}

impl crate::run::Run for Arguments {
    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let (a, b) = (arguments.reading.read(&arguments.a)?, arguments.reading.read(&arguments.b)?);
    let place = match arguments.one_place {
        true => Place::One,
        false => Place::of_stations(a.station.as_deref(), b.station.as_deref()),
    };
    let (a, b) = (a.imu, b.imu);
    let comparison = Comparison::at(place, &a, &b);
    if comparison.quantities.is_empty() {
        let message = format!(
            "{} and {} have no sensor in common: {}; {}",
            console::name(&arguments.a),
            console::name(&arguments.b),
            in_words(&a),
            in_words(&b)
        );
        return Err(Error::Experiment(Box::new(InputError::new(
            Refusal::CalibrationUnsuited,
            message,
            "compare calibrations of one sensor",
        ))));
    }
    tell_all(&comparison.notes);
    let (name_a, name_b) = (arguments.a.display().to_string(), arguments.b.display().to_string());
    let names = [(&name_a, &a), (&name_b, &b)].map(|(name, imu)| format!("{name} ({})", in_words(imu)));
    let file = ComparisonFile { comparison: &comparison, a: &name_a, b: &name_b };
    console::result(arguments.json, || to_json(&file), &comparison_sheet(&comparison, names), None, &[])?;
    Ok(Exit::DONE)
}
