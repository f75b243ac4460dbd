//! How the console speaks: with tables or without, in colour or without. Set once, before anything is said.

use clap::ColorChoice;
use std::io::IsTerminal;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// How the console speaks.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Manner {
    /// Only errors and warnings: no notes, no progress.
    pub(crate) quiet: bool,
    /// No tables on stdout.
    pub(crate) no_tables: bool,
    /// Colours on stderr.
    pub(crate) in_colour: bool,
}

static MANNER: OnceLock<Manner> = OnceLock::new();
static IS_LEFT: AtomicBool = AtomicBool::new(false);

/// Sets the manner.
pub(crate) fn set(manner: Manner) {
    // fails only where it is set already
    let _ = MANNER.set(manner);
}

/// Leaves stdout to a result that is written there: no tables from now on.
pub(crate) fn leave_stdout() {
    IS_LEFT.store(true, Ordering::Relaxed);
}

/// The manner that was set.
pub(super) fn get() -> Manner {
    let manner = MANNER.get().copied().unwrap_or_default();
    Manner { no_tables: manner.no_tables || IS_LEFT.load(Ordering::Relaxed), ..manner }
}

/// Does stderr show colours?
pub(crate) fn shows_colour(choice: ColorChoice) -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let dumb = || std::env::var_os("TERM").is_some_and(|terminal| terminal == "dumb");
    match choice {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => std::io::stderr().is_terminal() && !is_set("NO_COLOR") && !dumb(),
    }
}

/// The choice of `--color` among the arguments, for errors about the arguments themselves.
pub(crate) fn color_among(arguments: impl Iterator<Item = String>) -> ColorChoice {
    let mut arguments = arguments.take_while(|argument| argument != "--");
    let mut choice = None;
    while let Some(argument) = arguments.next() {
        match argument.strip_prefix("--color") {
            Some("") => choice = arguments.next(),
            Some(value) => choice = value.strip_prefix('=').map(str::to_owned).or(choice),
            None => {}
        }
    }
    choice.and_then(|choice| choice.parse().ok()).unwrap_or(ColorChoice::Auto)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_color_before_the_end_of_the_options_counts() {
        for (arguments, choice) in [
            ("design x.toml", ColorChoice::Auto),
            ("--color never design", ColorChoice::Never),
            ("--color=always design", ColorChoice::Always),
            ("--color=always --color never", ColorChoice::Never),
            ("--color pink", ColorChoice::Auto),
            ("--color", ColorChoice::Auto),
            ("design -- --color=always", ColorChoice::Auto),
        ] {
            assert_eq!(color_among(arguments.split(' ').map(str::to_owned)), choice, "{arguments}");
        }
    }
}
