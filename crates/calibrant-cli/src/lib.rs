//! The command line of calibrant: parse, call, print. One file per command.

mod apply;
mod budget;
mod calibrate;
mod calibration_file;
mod compare;
mod completions;
mod console;
mod convert;
mod design;
mod diagnostics;
mod exit;
mod experiment_settings;
mod explain;
mod figures;
#[cfg(feature = "guide")]
mod guide;
mod init;
mod inspect;
mod interruption;
mod man;
mod noise;
mod recording_options;
#[cfg(feature = "records")]
mod records;
#[cfg(any(test, not(feature = "records")))]
mod records_missing;
mod run;
mod schema;
mod simulate;
#[cfg(feature = "study")]
mod study;

use crate::diagnostics::{Rules, tell};
use calibrant::budget::Budget;
use calibrant::diagnostic::Phrase;
use calibrant::diagnostic::files::ResultLeftOver;
use calibrant::diagnostic::settings::ThreadsUnset;
use clap::{ArgMatches, ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand};
use console::Manner;
use exit::Exit;
#[cfg(not(feature = "records"))]
use records_missing as records;
use run::Run;
use std::ffi::OsString;

/// Calibrate accelerometers, gyroscopes and IMUs from a recording, and design the best motion to record.
///
/// Exit status: 0: done. 1: done, but a diagnostic occurred that `calibrate --deny` names. 2: the usage or the experiment file is wrong, or a result cannot be written. 3: the recording is unusable. 4: the data or the motion
/// do not determine the parameters, or the limits admit no motion, or not that of --evaluate. 5: a calibration is bad, or breaks a limit of [accept]. 130: interrupted; `design`, `study` and `calibrate` of several recordings have then written what they have.
#[derive(Parser)]
#[command(name = "calibrant", version, about, long_about, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Also write the figures of the report into this directory: figure-01.svg, with what it shows in figure-01.csv, and so on.
    #[arg(long, global = true, value_name = "DIR")]
    figures: Option<std::path::PathBuf>,
    /// Number of threads (default: all cores). Results do not depend on it.
    #[arg(long, global = true, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Replace files that calibrant did not write, and begin work of more than 8 GiB or an hour. Inputs are never replaced.
    #[arg(long, global = true)]
    force: bool,
    /// Print errors and warnings only: no table, no notes, no progress. With --json the JSON is printed.
    #[arg(short, long, global = true)]
    quiet: bool,
    /// Colours in messages. `auto`: where stderr is a terminal and NO_COLOR is not set.
    #[arg(long, global = true, value_name = "WHEN", default_value_t)]
    color: ColorChoice,
    #[command(flatten)]
    rules: Rules,
}

#[derive(Subcommand)]
enum Command {
    Init(init::Arguments),
    Inspect(inspect::Arguments),
    Design(design::Arguments),
    Simulate(simulate::Arguments),
    Calibrate(Box<calibrate::Arguments>),
    #[cfg(feature = "guide")]
    Guide(Box<guide::Arguments>),
    #[cfg(feature = "study")]
    Study(study::Arguments),
    Noise(noise::Arguments),
    Convert(convert::Arguments),
    Apply(apply::Arguments),
    Compare(compare::Arguments),
    Records(records::Arguments),
    Explain(explain::Arguments),
    Schema(schema::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
}

/// Runs the command line: the program with these arguments, the first of which is its name. Once in a process. Where the usage is wrong or help is asked for, it ends the process.
#[must_use]
pub fn main(arguments: Vec<OsString>) -> u8 {
    calibrant::error::word_options_as(console::as_flags);
    let color =
        console::color_among(arguments.iter().skip(1).map(|argument| argument.to_string_lossy().into()));
    let matches = Cli::command().color(color).get_matches_from(arguments);
    let mut cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    console::set_manner(Manner {
        quiet: cli.quiet,
        no_tables: cli.quiet && !asks_for_json(&matches),
        in_colour: console::shows_colour(cli.color),
    });
    match &mut cli.command {
        Command::Completions(arguments) => *arguments.program = Cli::command(),
        Command::Man(arguments) => *arguments.program = Cli::command(),
        _ => {}
    }
    std::mem::take(&mut cli.rules).set();
    if cli.force {
        budget::lift();
    }
    keep_large_blocks();
    let command: &dyn Run = match &cli.command {
        Command::Init(arguments) => arguments,
        Command::Inspect(arguments) => arguments,
        Command::Design(arguments) => arguments,
        Command::Simulate(arguments) => arguments,
        Command::Calibrate(arguments) => arguments.as_ref(),
        #[cfg(feature = "guide")]
        Command::Guide(arguments) => arguments.as_ref(),
        #[cfg(feature = "study")]
        Command::Study(arguments) => arguments,
        Command::Noise(arguments) => arguments,
        Command::Convert(arguments) => arguments,
        Command::Apply(arguments) => arguments,
        Command::Compare(arguments) => arguments,
        Command::Records(arguments) => arguments,
        Command::Explain(arguments) => arguments,
        Command::Schema(arguments) => arguments,
        Command::Completions(arguments) => arguments,
        Command::Man(arguments) => arguments,
    };
    figures::set(cli.figures);
    let done = set_threads(cli.threads).and_then(|()| run(command, cli.force));
    let exit = done.unwrap_or_else(|error| {
        console::error(&error);
        Exit::of(&error)
    });
    exit.max(Rules::exit()).0
}

/// Has the command `--json`, or a command of it?
fn asks_for_json(matches: &ArgMatches) -> bool {
    let Some((_, command)) = matches.subcommand() else { return false };
    let json = command.try_get_one::<bool>("json").ok().flatten();
    json.copied().unwrap_or(false) || asks_for_json(command)
}

/// Sets the number of threads, where the option or the environment gives one.
fn set_threads(threads: Option<u16>) -> calibrant::Result<()> {
    /// The stack of a thread, bytes.
    const STACK: f64 = (2 << 20) as f64;
    // what rayon reads; zero is its own choice
    let of_environment = ["RAYON_NUM_THREADS", "RAYON_RS_NUM_CPUS"].into_iter().find_map(|name| {
        let count = std::env::var(name).ok()?.parse::<usize>().ok()?;
        (count > 0).then(|| (count, format!("{count} threads ({name})")))
    });
    let given = threads.map(|count| (usize::from(count), format!("{count} threads")));
    let Some((count, what)) = given.or(of_environment) else { return Ok(()) };
    let work = Budget { bytes: STACK * count as f64, seconds: 0.0 };
    budget::check(work, &what, "take as many as there are cores")?;
    if let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(count).build_global() {
        tell(ThreadsUnset { why: Phrase(error.to_string()) });
    }
    Ok(())
}

/// Takes the places of the results, then runs the command. Tells results of an earlier run that it leaves.
fn run(command: &dyn Run, force: bool) -> calibrant::Result<Exit> {
    let mut places = command.places();
    places.results.extend(figures::places());
    if places.has_standard_output() {
        console::leave_stdout();
    }
    let claimed = places.claim(force)?;
    interruption::handle_signals();
    let outcome = command.run();
    if figures::are_missing() {
        console::told(calibrant::diagnostic::Severity::Note, "--figures: there are no figures to write");
    }
    let kept = command.kept();
    for left_over in claimed.left_over().filter(|path| !kept.iter().any(|of| of == path)) {
        tell(ResultLeftOver { file: Phrase(left_over.display().to_string()) });
    }
    outcome.map(|exit| if interruption::is_asked() { Exit::INTERRUPTED } else { exit })
}

/// Makes the allocator of glibc keep large blocks. It otherwise returns each freed block to the system, and takes
/// the next page by page. It keeps them after one block of nearly 32 MB has been allocated and freed. Other C
/// libraries do not need this.
fn keep_large_blocks() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(31 << 20)));
}
