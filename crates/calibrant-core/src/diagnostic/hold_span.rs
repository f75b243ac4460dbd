//! A hold that a diagnostic is about, and why it is not used.

use super::parts::{Part, Parts};
use crate::motion::Hold;
use crate::sensor::{Axis, ReadingUnit};
use std::fmt;

/// A hold by its number and its times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoldSpan {
    /// Its number, from 1.
    pub number: usize,
    /// Begin, s.
    pub start_s: f64,
    /// End, s.
    pub end_s: f64,
}

impl HoldSpan {
    /// The span of a hold. `number`: counted from 0.
    #[must_use]
    pub fn of(number: usize, hold: &Hold) -> Self {
        Self { number: number + 1, start_s: hold.start_s, end_s: hold.end_s }
    }
}

/// `hold 3 (12.0 to 15.5 s)`.
impl fmt::Display for HoldSpan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "hold {} ({:.1} to {:.1} s)", self.number, self.start_s, self.end_s)
    }
}

impl Part for HoldSpan {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(format!("hold {}", self.number));
        parts.numbers.extend([
            ("hold", self.number as f64),
            ("start_s", self.start_s),
            ("end_s", self.end_s),
        ]);
    }
}

/// Why a hold is not used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HoldReason {
    /// The accelerometer saturates in it.
    Saturated {
        /// On this axis.
        axis: Axis,
        /// At this reading.
        reading: f64,
        /// Unit of the reading.
        unit: ReadingUnit,
    },
    /// The magnitude of its mean contradicts gravity.
    MagnitudeOff {
        /// Gravity residual, m/s².
        residual_mps2: f64,
        /// The same in standard deviations expected of it.
        studentised: f64,
    },
}

impl fmt::Display for HoldReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Saturated { axis, reading, unit } => write!(
                f,
                "axis {axis} of the accelerometer saturates at {reading} {}; record with a larger range, or tilt that axis away from the vertical",
                unit.symbol()
            ),
            Self::MagnitudeOff { residual_mps2, studentised } => write!(
                f,
                "its gravity residual is {:.3} mm/s², {:.1} standard deviations",
                1e3 * residual_mps2,
                studentised.abs()
            ),
        }
    }
}

impl Part for HoldReason {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        match self {
            Self::Saturated { axis, reading, .. } => {
                axis.add_to(parts, "axis");
                parts.numbers.push(("saturates_at", *reading));
            }
            Self::MagnitudeOff { residual_mps2, studentised } => parts
                .numbers
                .extend([("magnitude_residual_mps2", *residual_mps2), ("deviations", *studentised)]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn a_hold_is_named_by_number_and_times() {
        let (mean, sd) = (Vector3::z(), Vector3::zeros());
        let hold = Hold { first: 0, end: 9, start_s: 12.04, end_s: 15.46, mean, sd };
        assert_eq!(HoldSpan::of(2, &hold).to_string(), "hold 3 (12.0 to 15.5 s)");
    }
}
