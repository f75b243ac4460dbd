//! A sensor that changes within the recording.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::sensor::Temperatures;

/// Each change, in words.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let follows = !evidence.problem.setup.thermal.is_none();
    let changes = &evidence.calibration.changes;
    if changes.is_empty() {
        return Vec::new();
    }
    let temperatures = Temperatures::of(evidence.problem.recording).ok().flatten().filter(|_| !follows);
    let range_c = temperatures.and_then(|temperatures| temperatures.range_c());
    changes.iter().map(|change| change.warning(range_c)).collect()
}
