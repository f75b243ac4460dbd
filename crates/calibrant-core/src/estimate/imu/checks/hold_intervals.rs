//! Intervals of holds that reach beyond where the sensor is still.

use crate::estimate::holds::beyond;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// Of the intervals that were given.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let given = evidence.problem.setup.holds.intervals_s.as_deref().unwrap_or_default();
    let stated = &evidence.accelerometer.warnings;
    let others = beyond(evidence.accelerometer_recording, given).into_iter();
    others.filter(|other| !stated.contains(other)).collect()
}
