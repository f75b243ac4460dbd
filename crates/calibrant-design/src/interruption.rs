//! The request to end a search early.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Asks searches to end soon, and to keep the best that they have. Clones ask together.
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
    pub(crate) fn or_at(&self, deadline: Option<Instant>) -> Self {
        Self { asked: Arc::clone(&self.asked), deadline }
    }

    /// Has anyone asked, or has the deadline passed?
    #[must_use]
    pub fn is_asked(&self) -> bool {
        self.asked.load(Ordering::Relaxed) || self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }
}

impl PartialEq for Interruption {
    /// Two are equal where one asks for both.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.asked, &other.asked) && self.deadline == other.deadline
    }
}
