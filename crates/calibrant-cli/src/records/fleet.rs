//! `calibrant records fleet`: how the parameters differ from sensor to sensor.

use crate::console;
use crate::exit::Exit;
use calibrant::io::to_json;
use calibrant::records::{Records, fleet_sheet};
use std::path::PathBuf;

/// Show the distribution of each parameter over all sensors, and the sensors that are farthest off.
///
/// The latest calibration of each sensor counts, unless it is bad. All are brought to the gauge and the reference temperature of the first.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    /// Print JSON instead of the table.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let fleet = Records::open_existing(&self.records)?.fleet()?;
        console::sheet(self.json, || to_json(&fleet), || fleet_sheet(&fleet));
        Ok(Exit::DONE)
    }
}
