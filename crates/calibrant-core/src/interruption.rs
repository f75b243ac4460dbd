//! The request to end a long task early. Every task that takes long looks at one now and then.

use crate::error::{Error, InputError, Refusal, Result};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Asks tasks to end soon. A search keeps the best that it has; a task without a best so far ends with [`Refusal::Interrupted`]. Clones ask together.
///
/// # Examples
/// ```
/// use calibrant_core::interruption::Interruption;
///
/// let (interruption, other) = (Interruption::default(), Interruption::default());
/// let of_signals = interruption.clone();
/// of_signals.ask();
/// assert!(interruption.is_asked() && interruption.check().is_err() && !other.is_asked());
/// ```
#[derive(Debug, Clone, Default)]
pub struct Interruption {
    asked: Arc<AtomicBool>,
    deadline: Option<Instant>,
}

impl Interruption {
    /// Asks. It cannot be taken back.
    pub fn ask(&self) {
        self.asked.store(true, Ordering::Relaxed);
    }

    /// The same request, which a deadline makes too.
    #[must_use]
    pub fn or_at(&self, deadline: Option<Instant>) -> Self {
        Self { asked: Arc::clone(&self.asked), deadline }
    }

    /// Has anyone asked, or has the deadline passed?
    #[must_use]
    pub fn is_asked(&self) -> bool {
        self.asked.load(Ordering::Relaxed) || self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// Ends a task that has nothing to keep.
    ///
    /// # Errors
    /// [`Refusal::Interrupted`], where it is asked.
    pub fn check(&self) -> Result<()> {
        match self.is_asked() {
            true => Err(Error::experiment(InputError::new(
                Refusal::Interrupted,
                "the work was interrupted, and there is no result yet",
                "begin it again",
            ))),
            false => Ok(()),
        }
    }
}

impl PartialEq for Interruption {
    /// Two are equal where one asks for both.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.asked, &other.asked) && self.deadline == other.deadline
    }
}
