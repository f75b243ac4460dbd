//! `calibrant records show`: one calibration with its parameters.

use crate::console;
use crate::exit::Exit;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::to_json;
use calibrant::records::{RecordFile, Records, record_sheet};
use std::path::PathBuf;

/// Show one calibration: where it comes from, its verdict and its parameters.
///
/// With --json, it is a calibration that `convert`, `compare` and `apply` read.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    /// The number of the calibration, as `list` shows it.
    id: i64,
    /// Print JSON instead of the table: parameters and covariance, as in calibration.json.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let Some(kept) = Records::open_existing(&self.records)?.get(self.id)? else {
            let message = format!("there is no calibration {}", self.id);
            let help = "`calibrant records list` shows the numbers";
            let error = InputError::new(Refusal::ValueInvalid, message, help).in_file(&self.records);
            return Err(Error::experiment(error));
        };
        console::sheet(self.json, || to_json(&RecordFile::of(&kept)), || record_sheet(&kept));
        Ok(Exit::DONE)
    }
}
