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

    /// The same; without a file this preset, which needs none.
    #[cfg(any(feature = "guide", feature = "study"))]
    pub(crate) fn read_or(&self, path: Option<&Path>, otherwise: &str) -> calibrant::Result<Experiment> {
        match path {
            Some(path) => self.read(path),
            None => Experiment::parse(calibrant::io::preset(otherwise).unwrap_or_default(), None),
        }
    }
}
