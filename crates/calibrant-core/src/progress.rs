//! How far a long task is, told to whoever waits for it.

use std::fmt;
use std::sync::Arc;

/// A step of a long task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// What is being done, in a word or two: `noise`.
    pub what: &'static str,
    /// Steps that are done.
    pub done: u64,
    /// Steps at most.
    pub of: u64,
}

/// Tells a listener how far a task is. The default tells nobody. Clones tell the same listener.
///
/// # Examples
/// ```
/// use calibrant_core::progress::Progress;
/// use std::sync::atomic::{AtomicU64, Ordering};
/// use std::sync::Arc;
///
/// let seen = Arc::new(AtomicU64::new(0));
/// let progress = Progress::to({ let seen = seen.clone(); move |step| seen.store(step.done, Ordering::Relaxed) });
/// progress.tell("noise", 3, 25);
/// assert_eq!(seen.load(Ordering::Relaxed), 3);
/// ```
#[derive(Clone, Default)]
pub struct Progress {
    listener: Option<Arc<dyn Fn(Step) + Send + Sync>>,
}

impl Progress {
    /// Tells this listener. It is called on any thread, and should return soon.
    #[must_use]
    pub fn to(listener: impl Fn(Step) + Send + Sync + 'static) -> Self {
        Self { listener: Some(Arc::new(listener)) }
    }

    /// Tells that so many steps are done.
    pub fn tell(&self, what: &'static str, done: u64, of: u64) {
        if let Some(listener) = &self.listener {
            listener(Step { what, done, of });
        }
    }
}

impl fmt::Debug for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.listener.is_some() { "Progress(told)" } else { "Progress(untold)" })
    }
}

impl PartialEq for Progress {
    /// Two are equal where one listener, or none, hears both.
    fn eq(&self, other: &Self) -> bool {
        match (&self.listener, &other.listener) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            (one, other) => one.is_none() && other.is_none(),
        }
    }
}
