//! How much a diagnostic matters.

/// How much a diagnostic matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Something to know. The result is sound.
    Note,
    /// The result may be wrong, or its standard deviations too small.
    Warning,
    /// The result must not be used.
    Error,
}

impl Severity {
    /// As files state it: `note`, `warning` or `error`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

crate::json_name!(Severity);
