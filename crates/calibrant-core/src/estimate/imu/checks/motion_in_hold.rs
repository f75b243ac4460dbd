//! Motion in a hold: the gyroscope turns where the accelerometer is still.

use crate::diagnostic::{Diagnostic, HoldSpan};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// The holds in which the gyroscope turns.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let used = evidence.used;
    let unit = evidence.problem.gyroscope.unit;
    let moved = |(j, rate): (usize, &Option<f64>)| {
        let hold = HoldSpan::of(used.numbers[j], used.holds[j]);
        Some(Diagnostic::HoldMoved { hold, rate_rms: (*rate)?, unit })
    };
    evidence.gyroscope.turning.iter().enumerate().filter_map(moved).collect()
}
