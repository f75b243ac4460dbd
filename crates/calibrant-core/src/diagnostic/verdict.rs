//! May a result be used? The diagnostics decide.

use crate::diagnostic::{Code, Severity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// May a result be used?
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Usability {
    /// Nothing speaks against it.
    Ok,
    /// A warning speaks against it.
    Doubtful,
    /// An error forbids it.
    Bad,
}

impl Usability {
    /// All of them, the best first.
    pub const ALL: [Self; 3] = [Self::Ok, Self::Doubtful, Self::Bad];

    /// The usability of this name.
    #[must_use]
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.name() == name)
    }

    /// As files state it: `ok`, `doubtful` or `bad`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Doubtful => "doubtful",
            Self::Bad => "bad",
        }
    }

    fn of(severity: Severity) -> Self {
        match severity {
            Severity::Allowed | Severity::Note => Self::Ok,
            Severity::Warning => Self::Doubtful,
            Severity::Error => Self::Bad,
        }
    }
}

crate::json_name!(Usability, Usability::ALL);

/// May a result be used, and which diagnostics decide it?
///
/// The severest code decides: an error makes a result bad, a warning makes it doubtful. Codes that the user allows do not count.
///
/// # Examples
/// ```
/// use calibrant_core::diagnostic::{Check, Usability, Verdict, datasheet::ScaleNegative, samples::CoarseSteps};
/// let codes = [CoarseSteps::CODE, ScaleNegative::CODE];
/// let verdict = Verdict::on(codes, &[]);
/// assert_eq!(verdict.to_string(), "bad (scale-negative)");
/// assert_eq!(Verdict::on(codes, &[ScaleNegative::CODE]).usability, Usability::Doubtful);
/// assert_eq!(Verdict::on([], &[]).to_string(), "ok");
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Verdict {
    /// May it be used?
    pub usability: Usability,
    /// The codes that decide it, each once, in the order of the diagnostics. None where it is ok.
    pub codes: Vec<Code>,
}

impl Verdict {
    /// The verdict on a result with these codes. `allowed` ones do not count.
    #[must_use]
    pub fn on(codes: impl IntoIterator<Item = Code>, allowed: &[Code]) -> Self {
        let mut verdict = Self { usability: Usability::Ok, codes: Vec::new() };
        for code in codes {
            let usability = Usability::of(code.severity());
            if usability == Usability::Ok || usability < verdict.usability || allowed.contains(&code) {
                continue;
            }
            if usability > verdict.usability {
                verdict = Self { usability, codes: Vec::new() };
            }
            if !verdict.codes.contains(&code) {
                verdict.codes.push(code);
            }
        }
        verdict
    }

    /// The names of the codes that decide it.
    #[must_use]
    pub fn code_names(&self) -> Vec<&'static str> {
        self.codes.iter().map(|code| code.name()).collect()
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.usability.name())?;
        if self.codes.is_empty() { Ok(()) } else { write!(f, " ({})", self.code_names().join(", ")) }
    }
}
