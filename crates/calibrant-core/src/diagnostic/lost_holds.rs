//! Holds that a low-pass filter breaks up.

use crate::diagnostic::parts::{Part, Parts};
use std::fmt;

/// Segments that look stationary but are no holds, because neighbouring samples are strongly correlated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LostHolds {
    /// Holds that were found.
    pub holds: usize,
    /// Other segments that look stationary.
    pub stretches: usize,
    /// Shortest hold, s.
    pub minimum_s: f64,
}

impl LostHolds {
    /// Why the holds are broken up.
    pub(crate) const REASON: &'static str =
        "neighbouring samples are strongly correlated, as behind a low-pass filter far below the sample rate";
    /// What to do about it.
    pub(crate) const HELP: &'static str =
        "give holds.intervals_s, hold longer, or record with a wider bandwidth";
}

/// The loss as files state it.
impl fmt::Display for LostHolds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.holds {
            1 => write!(f, "1 hold is found")?,
            count => write!(f, "{count} holds are found")?,
        }
        write!(
            f,
            ". {} other segments look stationary, but not for {} s without interruption: {}. Remedy: {}.",
            self.stretches,
            self.minimum_s,
            Self::REASON,
            Self::HELP
        )
    }
}

impl Part for LostHolds {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.numbers.extend([
            ("holds", self.holds as f64),
            ("stretches", self.stretches as f64),
            ("minimum_s", self.minimum_s),
        ]);
    }
}
