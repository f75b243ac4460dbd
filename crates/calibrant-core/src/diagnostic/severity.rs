//! How much a diagnostic matters.

/// How much a diagnostic matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The user allows it: it is kept, but not told of, and does not count for the verdict.
    Allowed,
    /// Something to know. The result is sound.
    Note,
    /// The result may be wrong, or its standard deviations too small.
    Warning,
    /// The result must not be used.
    Error,
}

impl Severity {
    /// All of them, the least first.
    pub const ALL: [Self; 4] = [Self::Allowed, Self::Note, Self::Warning, Self::Error];

    /// As files state it: `allowed`, `note`, `warning` or `error`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Allowed => "allowed",
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

crate::json_name!(Severity, Severity::ALL);
