//! The width of what is printed. What goes to a file or another program is as wide as a terminal usually is.

use std::sync::OnceLock;

/// Narrower terminals are taken to be this wide.
const LEAST: usize = 40;
/// The width where stdout is no terminal.
const USUAL: usize = 80;

/// The width that a result has.
pub(super) fn get() -> usize {
    static WIDTH: OnceLock<usize> = OnceLock::new();
    *WIDTH.get_or_init(|| {
        let measured = terminal_size::terminal_size_of(std::io::stdout());
        measured.map_or(USUAL, |(width, _)| usize::from(width.0).max(LEAST))
    })
}
