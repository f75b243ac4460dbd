//! `calibrant records` of a build without records: the command that installs one with them.

use crate::exit::Exit;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::install_with;
use std::ffi::OsString;

/// Ask records of calibrations: the history of a sensor, its aging per year, the distribution of all sensors.
///
/// This build has none: each of these commands says how to install one with them.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// A command of the records, and its arguments.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    _command: Vec<OsString>,
}

impl crate::run::Run for Arguments {
    fn run(&self) -> calibrant::Result<Exit> {
        let message = "this build keeps no records";
        Err(Error::experiment(InputError::new(Refusal::FormatUnsupported, message, install_with("records"))))
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    #[derive(Parser)]
    struct Records {
        #[command(flatten)]
        arguments: super::Arguments,
    }

    #[test]
    fn every_command_of_the_records_says_how_to_install_them() {
        for command in ["list r.db", "drift r.db A17 --json", "fleet --help"] {
            let words = ["records"].into_iter().chain(command.split(' '));
            let Records { arguments } =
                Records::try_parse_from(words).unwrap_or_else(|error| panic!("{error}"));
            let refused = crate::run::Run::run(&arguments).err().expect("no records").to_string();
            let remedy = "cargo install --locked --path crates/calibrant-cli --features records";
            assert!(refused.contains(remedy), "{refused}");
        }
    }
}
