//! The range that a number must lie in, and its words in messages.

use std::fmt;

/// The range of a number and its unit.
pub(super) struct Bounds {
    least: f64,
    open: bool,
    most: f64,
    unit: &'static str,
}

impl Bounds {
    /// Above `least`, up to `most`.
    pub(super) const fn above(least: f64, most: f64, unit: &'static str) -> Self {
        Self { least, open: true, most, unit }
    }

    /// From `least` to `most`.
    pub(super) const fn from(least: f64, most: f64, unit: &'static str) -> Self {
        Self { least, open: false, most, unit }
    }

    /// Is this number within? NaN is not.
    pub(super) fn contain(&self, number: f64) -> bool {
        number <= self.most && if self.open { number > self.least } else { number >= self.least }
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { least, open, most, unit } = self;
        let space = if unit.is_empty() { "" } else { " " };
        let [least, most] = [least, most].map(|&bound| {
            let plain = bound == 0.0 || (1e-3..1e6).contains(&bound.abs());
            if plain { bound.to_string() } else { format!("{bound:e}") }
        });
        write!(
            f,
            "a number {} {least}{space}{unit}, at most {most}{space}{unit}",
            if *open { "above" } else { "from" }
        )
    }
}
