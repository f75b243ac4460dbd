//! The budget of this run: the usual one, or none with --force.

use calibrant::Error;
use calibrant::budget::Budget;
use std::sync::atomic::{AtomicBool, Ordering};

static LIFTED: AtomicBool = AtomicBool::new(false);

/// Lifts the budget of this run.
pub(crate) fn lift() {
    LIFTED.store(true, Ordering::Relaxed);
}

/// The budget of this run.
pub(crate) fn budget() -> Budget {
    if LIFTED.load(Ordering::Relaxed) { Budget::UNLIMITED } else { Budget::USUAL }
}

/// Checks that the budget of this run allows `work`. `what` names the work, `less` says how it becomes less.
pub(crate) fn check(work: Budget, what: &str, less: &str) -> calibrant::Result<()> {
    budget().check(work, what, less).map_err(Error::Experiment)
}
