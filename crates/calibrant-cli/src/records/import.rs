//! `calibrant records import`: the data set of a fleet becomes records.

use crate::console;
use crate::exit::Exit;
use calibrant::records::{DataSet, Imported, Records};
use calibrant::report::number_format::counted;
use std::path::PathBuf;

/// Import the data set that calibrant.fleet.calibrate of the Python package wrote.
///
/// A calibration of a recording, experiment, motion and version that the records have already takes the place of that one, so a data set that has grown is imported again.
/// All rows are read before the first is added. Rows without a calibration are left out. So are recordings with the same bytes under the names of several sensors: nobody knows of which they are.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records. They are made where there are none.
    records: PathBuf,
    /// The folder with the parts of the data set, or one file of Parquet.
    #[arg(value_name = "DIR")]
    data_set: PathBuf,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        // before the records are made
        let data_set = DataSet::read(&self.data_set)?;
        let Imported { new, replaced, without_calibration, copies } =
            Records::open(&self.records)?.import(&data_set)?;
        let mut sentence = format!("{}, {replaced} replaced", counted(new, "new calibration"));
        if without_calibration > 0 {
            sentence += &format!(", {} without a calibration left out", counted(without_calibration, "row"));
        }
        console::print(&format!("{sentence}: {}\n", console::name(&self.records)));
        for files in copies {
            let files = files.join(", ");
            console::print(&format!(
                "left out, as they have the same bytes: {}\n",
                console::in_one_line(&files)
            ));
        }
        Ok(Exit::DONE)
    }
}
