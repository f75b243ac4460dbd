//! `calibrant records drift`: what changes from calibration to calibration, and per year.

use crate::console;
use crate::exit::Exit;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::to_json;
use calibrant::records::{Records, drift_sheet, history_sheet};
use std::path::PathBuf;

/// Show how a sensor changes from calibration to calibration, and per year. Without a sensor: which sensors changed most.
///
/// Changes are compared as by `calibrant compare`. The aging is a line through the dated calibrations that are not bad, by weighted least squares.
/// Where they scatter by more than their standard deviations, that of the aging is widened by the Birge ratio.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    /// The sensor.
    sensor: Option<String>,
    /// Print JSON instead of the tables.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let records = Records::open_existing(&self.records)?;
        match &self.sensor {
            Some(sensor) => {
                let history = records.history(sensor)?;
                if history.calibrations.is_empty() {
                    let message = format!("there is no calibration of sensor {sensor:?}");
                    let help = "`calibrant records list` shows the sensors";
                    let error = InputError::new(Refusal::ValueInvalid, message, help).in_file(&self.records);
                    return Err(Error::experiment(error));
                }
                console::sheet(self.json, || to_json(&history), || history_sheet(&history));
            }
            None => {
                let drifts = records.drifts()?;
                console::sheet(self.json, || to_json(&drifts), || drift_sheet(&drifts));
            }
        }
        Ok(Exit::DONE)
    }
}
