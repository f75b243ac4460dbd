//! Coarse steps of the gyroscope.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::quantisation::CoarseAxis;

/// The axes that have them.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let unit = evidence.problem.gyroscope.unit.symbol();
    let words = |found: &CoarseAxis| {
        format!(
            "{}; the standard deviations know of it; choose a smaller range, or more digits in the file",
            found.words("gyroscope", unit)
        )
    };
    evidence.gyroscope.coarse.iter().map(words).collect()
}
