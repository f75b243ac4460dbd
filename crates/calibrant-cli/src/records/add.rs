//! `calibrant records add`: calibrations that are there already become records.

use crate::console;
use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::diagnostic::Diagnostic;
use calibrant::diagnostic::comparison::RecordUnused;
use calibrant::estimate::CalibrationStatus;
use calibrant::records::{Record, Records};
use calibrant::report::number_format;
use std::path::PathBuf;

/// Add calibrations that are there already, such as results/*/calibration.json.
///
/// A calibration of a recording, experiment, motion and version that the records have already takes the place of that one. A recording that they have of another sensor is refused.
/// All files are read before the first is added.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records. They are made where there are none.
    records: PathBuf,
    /// The files calibration.json.
    #[arg(required = true)]
    calibrations: Vec<PathBuf>,
    /// Where the recordings were made, of calibrations that do not name their station.
    #[arg(long, value_name = "NAME")]
    station: Option<String>,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let mut read =
            self.calibrations.iter().map(|path| Record::read(path)).collect::<calibrant::Result<Vec<_>>>()?;
        let given = read.len();
        for (record, path) in read.iter_mut().zip(&self.calibrations) {
            if record.station.is_none() {
                record.station.clone_from(&self.station);
            }
            if record.status != CalibrationStatus::Converged.name() {
                let unused = RecordUnused { status: record.status.clone() };
                tell(Diagnostic::from(unused).in_file(path.display().to_string()));
            }
        }
        let new = Records::open(&self.records)?.insert_all(read)?;
        let new_ones = number_format::counted(new, "new calibration");
        console::print(&format!("{new_ones}, {} replaced: {}\n", given - new, console::name(&self.records)));
        Ok(Exit::DONE)
    }
}
