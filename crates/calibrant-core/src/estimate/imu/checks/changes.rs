//! A sensor that changes within the recording.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::change::SensorChanged;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::sensor::Temperatures;

/// Each change.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let follows = !evidence.problem.setup.thermal.is_none();
    let changes = &evidence.calibration.changes;
    if changes.is_empty() {
        return Vec::new();
    }
    let temperatures = Temperatures::of(evidence.problem.recording).ok().flatten().filter(|_| !follows);
    let range_c = temperatures.and_then(|temperatures| temperatures.range_c());
    let [coldest_c, hottest_c] = range_c.map_or([None; 2], |range_c| range_c.map(Some));
    changes
        .iter()
        .map(|change| Diagnostic::from(SensorChanged { change: *change, coldest_c, hottest_c }))
        .collect()
}
