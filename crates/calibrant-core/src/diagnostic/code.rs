//! The code of a check, and its entry.

use super::severity::Severity;
use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};

/// The entry of a code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CodeEntry {
    /// Its name, which never changes: `hold-moved`.
    pub name: &'static str,
    /// How much it matters.
    pub severity: Severity,
    /// What it means.
    pub meaning: &'static str,
    /// How it is decided.
    pub decided: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

/// The stable name of a check, like a linter's rule, and its entry: see [`Check::CODE`](super::Check::CODE).
#[derive(Clone, Copy)]
pub struct Code(&'static CodeEntry);

impl Code {
    pub(super) const fn new(entry: &'static CodeEntry) -> Self {
        Self(entry)
    }

    /// Its entry.
    #[must_use]
    pub fn entry(self) -> &'static CodeEntry {
        self.0
    }

    /// Its name, which never changes: `hold-moved`.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// How much it matters.
    #[must_use]
    pub fn severity(self) -> Severity {
        self.0.severity
    }
}

impl PartialEq for Code {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Code {}

impl PartialOrd for Code {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Code {
    fn cmp(&self, other: &Self) -> Ordering {
        self.name().cmp(other.name())
    }
}

impl Hash for Code {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.name().hash(state);
    }
}

impl fmt::Debug for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
