//! The program `calibrant`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(calibrant_cli::main(std::env::args_os().collect()))
}
