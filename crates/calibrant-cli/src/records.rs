//! `calibrant records`: what was calibrated so far, of which sensors, and how they change.

mod add;
mod drift;
mod export;
mod fleet;
#[cfg(feature = "parquet")]
mod import;
mod list;
mod remove;
mod selection;
mod show;

use crate::exit::Exit;
use calibrant::io::ResultPlaces;

/// Ask records of calibrations: the history of a sensor, its aging per year, the distribution of all sensors.
///
/// `calibrant calibrate --records FILE` adds to the records. They are an SQLite database: its tables and views can be asked in SQL, too.
#[derive(clap::Args)]
#[command(subcommand_required = true, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    List(list::Arguments),
    Show(show::Arguments),
    Drift(drift::Arguments),
    Fleet(fleet::Arguments),
    Export(export::Arguments),
    Add(add::Arguments),
    #[cfg(feature = "parquet")]
    Import(import::Arguments),
    Remove(remove::Arguments),
}

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        match &self.command {
            Command::Export(arguments) => arguments.places(),
            _ => ResultPlaces::default(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        match &self.command {
            Command::List(arguments) => arguments.run(),
            Command::Show(arguments) => arguments.run(),
            Command::Drift(arguments) => arguments.run(),
            Command::Fleet(arguments) => arguments.run(),
            Command::Export(arguments) => arguments.run(),
            Command::Add(arguments) => arguments.run(),
            #[cfg(feature = "parquet")]
            Command::Import(arguments) => arguments.run(),
            Command::Remove(arguments) => arguments.run(),
        }
    }
}
