//! The request to end a search early.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Asks searches to end soon, and to keep the best that they have. Clones ask together.
#[derive(Debug, Clone, Default)]
pub struct Interruption(Arc<AtomicBool>);

impl Interruption {
    /// Asks. It cannot be taken back.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Has anyone asked?
    #[must_use]
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl PartialEq for Interruption {
    /// Two are equal where one asks for both.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
