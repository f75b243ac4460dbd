//! Motion in holds: the gyroscope turns where the accelerometer is still.

use crate::diagnostic::holds::HoldMoved;
use crate::diagnostic::{Diagnostic, HoldSpan};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// The holds in which the gyroscope turns.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let (used, gyroscope) = (evidence.used, evidence.gyroscope);
    let holds: Vec<HoldSpan> = gyroscope
        .turning_places()
        .map(|place| HoldSpan::of(used.numbers[place], used.holds[place]))
        .collect();
    let rate_rms = gyroscope.turning.iter().flatten().copied().fold(0.0, f64::max);
    let (unit, are_given) = (evidence.problem.gyroscope.unit, evidence.problem.setup.holds.times_are_given());
    let moved = Diagnostic::from(HoldMoved { holds, rate_rms, unit, are_given });
    if rate_rms > 0.0 { vec![moved] } else { Vec::new() }
}
