//! `calibrant records list`: the calibrations, a line for each.

use super::selection::Selection;
use crate::console;
use crate::exit::Exit;
use calibrant::io::to_json;
use calibrant::records::{Records, records_sheet};
use std::path::PathBuf;

/// List calibrations: by sensor, and by date.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    #[command(flatten)]
    selection: Selection,
    /// Print JSON instead of the table.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let records = Records::open_existing(&self.records)?.list(&self.selection.filter())?;
        console::sheet(self.json, || to_json(&records), || records_sheet(&records));
        Ok(Exit::DONE)
    }
}
