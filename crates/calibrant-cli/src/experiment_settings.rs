//! The option of all commands that read an experiment file: other values than the file has.

use calibrant::io::Experiment;
use std::path::Path;

#[derive(clap::Args, Clone)]
pub(crate) struct Settings {
    /// Another value of a key than that of the experiment file: holds.hold_s=8, sensor.model=scale-bias. Repeatable.
    #[arg(long = "set", value_name = "SECTION.KEY=VALUE", requires = "experiment")]
    set: Vec<String>,
}

impl Settings {
    /// Reads the experiment with them.
    pub(crate) fn read(&self, path: &Path) -> calibrant::Result<Experiment> {
        Experiment::read_with(path, &self.set)
    }
}
