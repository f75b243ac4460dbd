//! What Ctrl-C and its like do: the first ends work that keeps what it has; every other ends the program.

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

/// The interruption of work that keeps what it has. From now on, the first signal asks it, and leaves the program running.
pub(crate) fn keeping_the_best() -> Interruption {
    KEEPS.store(true, Ordering::Relaxed);
    INTERRUPTION.clone()
}

/// Has the work been interrupted?
pub(crate) fn is_asked() -> bool {
    INTERRUPTION.is_asked()
}

/// Handles the signals that ask the program to end. A signal that the program was started to ignore, as by `nohup` or in the background of a script, is left
/// alone; the others are handled all the same.
pub(crate) fn handle_signals() {
    #[cfg(unix)]
    unix::report_full_files();
    #[cfg(unix)]
    if let Ok(mut signals) = signal_hook::iterator::Signals::new(unix::not_ignored()) {
        std::thread::spawn(move || signals.forever().for_each(|_| interrupt()));
    }
    #[cfg(not(unix))]
    let _ = ctrlc::try_set_handler(interrupt);
}

/// What a signal does.
fn interrupt() {
    if KEEPS.load(Ordering::Relaxed) && !INTERRUPTION.is_asked() {
        INTERRUPTION.ask();
        tell(Interrupted {});
        return;
    }
    // otherwise temporary files would be left
    remove_unfinished();
    std::process::exit(Exit::INTERRUPTED.0.into());
}

#[cfg(unix)]
mod unix {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    /// A file that reaches the limit of the shell (`ulimit -f`) then fails to be written, as one on a full disk does, in place of ending the program.
    pub(super) fn report_full_files() {
        // that the signal came says nothing that the error of the write does not
        drop(signal_hook::flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false))));
    }

    /// The signals that ask the program to end, without those that it was started to ignore.
    pub(super) fn not_ignored() -> Vec<i32> {
        // only Linux tells without unsafe code; elsewhere `nohup` is taken to be in use
        let status = std::fs::read_to_string("/proc/self/status").ok();
        let ignored = status.as_deref().and_then(ignored_in).unwrap_or(1 << (SIGHUP - 1));
        [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0).collect()
    }

    /// The ignored signals, a bit for each, in the status of a process.
    fn ignored_in(status: &str) -> Option<u64> {
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"))?;
        u64::from_str_radix(mask.trim(), 16).ok()
    }
}
