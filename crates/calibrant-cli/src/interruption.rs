//! What Ctrl-C and its like do: the first ends a search that keeps its best; every other ends the program.

use crate::diagnostics::tell;
use crate::exit::Exit;
use calibrant::design::Interruption;
use calibrant::diagnostic::settings::Interrupted;
use calibrant::io::remove_unfinished;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// Does this run keep what it has, where it is interrupted?
static KEEPS: AtomicBool = AtomicBool::new(false);
static INTERRUPTION: LazyLock<Interruption> = LazyLock::new(Interruption::default);

/// The interruption of a search. From now on, the first signal asks it, and leaves the program running.
pub(crate) fn keeping_the_best() -> Interruption {
    KEEPS.store(true, Ordering::Relaxed);
    INTERRUPTION.clone()
}

/// Has a search been interrupted?
pub(crate) fn is_asked() -> bool {
    INTERRUPTION.is_asked()
}

/// Handles the signals that ask the program to end. One of `nohup` is not taken.
pub(crate) fn handle_signals() {
    let _ = ctrlc::try_set_handler(|| {
        if KEEPS.load(Ordering::Relaxed) && !INTERRUPTION.is_asked() {
            INTERRUPTION.ask();
            tell(Interrupted {});
            return;
        }
        // otherwise temporary files would be left
        remove_unfinished();
        std::process::exit(Exit::INTERRUPTED.0.into());
    });
}
