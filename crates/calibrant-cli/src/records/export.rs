//! `calibrant records export`: the records as a table for other programs.

use super::selection::Selection;
use crate::console;
use crate::exit::Exit;
use calibrant::io::{ResultPlaces, TableFormat};
use calibrant::records::Records;
use calibrant::report::number_format;
use std::path::PathBuf;

/// Write calibrations as a table: one row for each, with value and standard deviation of each parameter.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    #[command(flatten)]
    selection: Selection,
    /// The table: .csv or .parquet.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

impl Arguments {
    pub(super) fn places(&self) -> ResultPlaces {
        ResultPlaces {
            results: vec![self.output.clone()],
            inputs: vec![self.records.clone()],
            ..ResultPlaces::default()
        }
    }

    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        TableFormat::of(&self.output)?;
        let records = Records::open_existing(&self.records)?;
        let rows = records.export(&self.output, &self.selection.filter())?;
        let rows = number_format::counted(rows, "calibration");
        console::print(&format!("{rows}: {}\n", console::name(&self.output)));
        Ok(Exit::DONE)
    }
}
