//! `calibrant records remove`: calibrations that do not belong there.

use crate::console;
use crate::exit::Exit;
use calibrant::records::Records;
use calibrant::report::number_format;
use std::path::PathBuf;

/// Remove calibrations, such as those with the name of a wrong sensor.
///
/// All are removed, or none: a number that is not there is an error. The results of the calibrations stay.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    /// The numbers of the calibrations, as `list` shows them.
    #[arg(required = true, value_name = "ID")]
    ids: Vec<i64>,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let mut records = Records::open_existing(&self.records)?;
        let before = records.count()?;
        records.remove(&self.ids)?;
        let removed = number_format::counted(before - records.count()?, "calibration");
        console::print(&format!("{removed} removed: {}\n", console::name(&self.records)));
        Ok(Exit::DONE)
    }
}
