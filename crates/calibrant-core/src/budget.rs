//! The budget of work: its memory and time, estimated before it begins. Estimates are right within a factor of a few.

use crate::error::{InputError, Refusal};
use std::ops::Add;

/// An amount of memory and time: what work takes, or what it may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Budget {
    /// Memory, bytes.
    pub bytes: f64,
    /// Time of one processor, s.
    pub seconds: f64,
}

impl Budget {
    /// What work may take without being asked for twice.
    pub const USUAL: Self = Self { bytes: (8_u64 << 30) as f64, seconds: 3600.0 };
    /// Nothing at all.
    pub const NONE: Self = Self { bytes: 0.0, seconds: 0.0 };
    /// For a caller who insists.
    pub const UNLIMITED: Self = Self { bytes: f64::INFINITY, seconds: f64::INFINITY };

    /// What it takes to simulate so many samples, and to write them.
    #[must_use]
    pub fn of_samples(count: f64) -> Self {
        Self { bytes: 100.0 * count, seconds: 1e-6 * count }
    }

    /// The same so many times, one after the other: each has the memory of the one before.
    #[must_use]
    pub fn repeated(self, times: f64) -> Self {
        Self { seconds: times * self.seconds, ..self }
    }

    /// Checks that this budget allows `work`. `what` names the work, `less` says how it becomes less.
    ///
    /// # Errors
    /// [`Refusal::WorkTooLarge`] with the amount, where it does not.
    pub fn check(&self, work: Self, what: &str, less: &str) -> Result<(), Box<InputError>> {
        if work.bytes <= self.bytes && work.seconds <= self.seconds {
            return Ok(());
        }
        let message = format!(
            "{what} would take about {} of memory and {} of one processor, more than {} or {}",
            size(work.bytes),
            duration(work.seconds),
            size(self.bytes),
            duration(self.seconds)
        );
        Err(Box::new(InputError::new(
            Refusal::WorkTooLarge,
            message,
            format!("{less}, or add option `force`"),
        )))
    }
}

impl Default for Budget {
    fn default() -> Self {
        Self::USUAL
    }
}

impl Add for Budget {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { bytes: self.bytes + other.bytes, seconds: self.seconds + other.seconds }
    }
}

/// `8 GiB`.
fn size(bytes: f64) -> String {
    in_units(bytes, &[("GiB", (1_u64 << 30) as f64), ("MiB", (1_u64 << 20) as f64)])
}

/// `1 h`.
fn duration(seconds: f64) -> String {
    in_units(seconds, &[("h", 3600.0), ("s", 1.0)])
}

/// A number in the first unit of which there is one at least, or else in the last.
fn in_units(value: f64, units: &[(&str, f64)]) -> String {
    let last = units[units.len() - 1];
    let (unit, size) = units.iter().copied().find(|(_, size)| value >= *size).unwrap_or(last);
    let count = value / size;
    if count < 9.95 {
        format!("{} {unit}", (10.0 * count).round() / 10.0)
    } else if count < 1e6 {
        format!("{count:.0} {unit}")
    } else {
        format!("{count:.0e} {unit}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_beyond_the_budget_is_refused_with_its_amount() {
        let usual = Budget::USUAL;
        assert_eq!(usual.check(Budget::of_samples(1e7), "it", "less"), Ok(()));
        assert_eq!(Budget::UNLIMITED.check(Budget::of_samples(1e300), "it", "less"), Ok(()));
        let refused =
            usual.check(Budget::of_samples(1e9), "1e9 samples", "lower the rate").expect_err("large");
        assert_eq!(refused.code, Refusal::WorkTooLarge);
        assert_eq!(
            refused.to_string(),
            "1e9 samples would take about 93 GiB of memory and 1000 s of one processor, more than 8 GiB or 1 h \
             (lower the rate, or add option `force`)"
        );
        let long = Budget { bytes: 0.0, seconds: 3e10 };
        assert!(
            usual.check(long, "it", "less").expect_err("long").message.contains("0 MiB of memory and 8e6 h")
        );
    }
}
