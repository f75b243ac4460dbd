//! What every command is to the program.

use crate::exit::Exit;
use calibrant::io::ResultPlaces;

/// A command: what it reads and writes, and its work.
pub(crate) trait Run {
    /// What it reads and writes; nothing, where it only prints.
    fn places(&self) -> ResultPlaces {
        ResultPlaces::default()
    }

    fn run(&self) -> calibrant::Result<Exit>;
}
