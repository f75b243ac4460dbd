//! The width of what is printed. What goes to a file or another program is as wide as a terminal usually is.

use std::sync::OnceLock;

/// Narrower terminals are taken to be this wide.
const LEAST: usize = 40;
/// The width where stdout is no terminal.
const USUAL: usize = 80;

/// The width of the terminal on stdout; `None` where stdout is none.
pub(super) fn of_terminal() -> Option<usize> {
    static WIDTH: OnceLock<Option<usize>> = OnceLock::new();
    let measured = || terminal_size::terminal_size_of(std::io::stdout()).map(|(width, _)| width.0.into());
    WIDTH.get_or_init(measured).map(|width: usize| width.max(LEAST))
}

/// The width that a result has.
pub(super) fn get() -> usize {
    of_terminal().unwrap_or(USUAL)
}
