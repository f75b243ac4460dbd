//! Motion in a hold: the gyroscope turns where the accelerometer is still.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// The holds in which the gyroscope turns.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let used = evidence.used;
    let unit = evidence.problem.gyroscope.unit.symbol();
    let words = |(j, rate): (usize, &Option<f64>)| {
        let rate = (*rate)?;
        Some(format!(
            "the gyroscope turns in {}, by {rate:.2e} {} rms: what it shows there is not taken for its bias; an accelerometer does not see a turn \
             about the vertical: correct holds.intervals_s, or leave them away so that holds are looked for",
            used.holds[j].named(used.numbers[j]),
            unit
        ))
    };
    evidence.gyroscope.turning.iter().enumerate().filter_map(words).collect()
}
