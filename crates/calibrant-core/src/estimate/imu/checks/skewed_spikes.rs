//! Spikes of the gyroscope in the holds that all point the same way.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::skewed_spikes::skewed_spikes;
use crate::sensor::SensorKind;

/// They move the means.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let Some(gyroscope) = &evidence.problem.recording.gyroscope else { return Vec::new() };
    let used = evidence.calibration.hold_results().iter().filter(|hold| hold.used).map(|result| &result.hold);
    skewed_spikes(gyroscope, SensorKind::Gyroscope, used).into_iter().collect()
}
