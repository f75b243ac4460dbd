//! Spikes of the gyroscope in the holds that all point the same way.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::one_sided::one_sided;
use crate::sensor::Triad;

/// They move the means.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let Some(gyroscope) = &evidence.problem.recording.gyroscope else { return Vec::new() };
    let used = evidence.calibration.holds.holds.iter().filter(|hold| hold.used).map(|result| &result.hold);
    one_sided(gyroscope, Triad::Gyroscope, used).into_iter().collect()
}
