//! The command line of calibrant: parse, call, print. One file per command.

mod apply;
mod calibrate;
mod calibration_file;
mod compare;
mod console;
mod convert;
mod design;
mod diagnostics;
mod exit;
mod init;
mod inspect;
mod noise;
mod recording_options;
mod run;
mod simulate;
mod study;

use calibrant::io::remove_unfinished;
use clap::{Parser, Subcommand};
use exit::Exit;
use run::Run;
use std::process::ExitCode;

/// Calibrate accelerometers, gyroscopes and IMUs from a recording, and design the best motion to record.
///
/// Exit status: 0: done. 1: done, but a diagnostic occurred that `calibrate --deny` names. 2: the usage or the experiment file is wrong, or a result cannot be written. 3: the recording is unusable. 4: the data or the motion
/// do not determine the parameters, the limits admit no motion, or the iteration did not converge.
#[derive(Parser)]
#[command(name = "calibrant", version, about, long_about, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Number of threads (default: all cores). Results do not depend on it.
    #[arg(long, global = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Replace files that calibrant did not write. Inputs are never replaced.
    #[arg(long, global = true)]
    force: bool,
}

#[derive(Subcommand)]
enum Command {
    Init(init::Arguments),
    Inspect(inspect::Arguments),
    Design(design::Arguments),
    Simulate(simulate::Arguments),
    Calibrate(calibrate::Arguments),
    Study(study::Arguments),
    Noise(noise::Arguments),
    Convert(convert::Arguments),
    Apply(apply::Arguments),
    Compare(compare::Arguments),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    if let Some(threads) = cli.threads
        && let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()
    {
        console::note(&format!("cannot set the number of threads: {error}"));
    }
    keep_large_blocks();
    let command: &dyn Run = match &cli.command {
        Command::Init(arguments) => arguments,
        Command::Inspect(arguments) => arguments,
        Command::Design(arguments) => arguments,
        Command::Simulate(arguments) => arguments,
        Command::Calibrate(arguments) => arguments,
        Command::Study(arguments) => arguments,
        Command::Noise(arguments) => arguments,
        Command::Convert(arguments) => arguments,
        Command::Apply(arguments) => arguments,
        Command::Compare(arguments) => arguments,
    };
    let exit = run(command, cli.force).unwrap_or_else(|error| {
        console::error(&error);
        Exit::of(&error)
    });
    ExitCode::from(exit.0)
}

/// Takes the places of the results, then runs the command. Tells results of an earlier run that it leaves.
fn run(command: &dyn Run, force: bool) -> calibrant::Result<Exit> {
    let claimed = command.places().claim(force)?;
    // without the handler, a run that is interrupted leaves temporary files; one of `nohup` takes none
    let _ = ctrlc::try_set_handler(|| {
        remove_unfinished();
        std::process::exit(Exit::INTERRUPTED.0.into());
    });
    let outcome = command.run();
    for left_over in claimed.left_over() {
        console::warn(&format!("{} is that of an earlier run", left_over.display()));
    }
    outcome
}

/// Makes the allocator of glibc keep large blocks. It otherwise returns each freed block to the system, and takes
/// the next page by page. It keeps them after one block of nearly 32 MB has been allocated and freed. Other C
/// libraries do not need this.
fn keep_large_blocks() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(31 << 20)));
}
