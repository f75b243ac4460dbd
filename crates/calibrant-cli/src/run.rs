//! What every command is to the program.

use crate::exit::Exit;
use calibrant::io::ResultPlaces;
use std::path::PathBuf;

/// A command: what it reads and writes, and its work.
pub(crate) trait Run {
    /// What it reads and writes; nothing, where it only prints.
    fn places(&self) -> ResultPlaces {
        ResultPlaces::default()
    }

    /// Results of an earlier run that are those of this one, too. It is asked after the run.
    fn kept(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    fn run(&self) -> calibrant::Result<Exit>;
}
