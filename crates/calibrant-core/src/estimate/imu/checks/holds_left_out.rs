//! Holds that were left out, and what the accelerometer's own fit says.

use crate::estimate::holds::left_out;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// By the parameters of the whole IMU, in place of what the static fit said of the same holds.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let first = evidence.accelerometer;
    let stated_before = left_out(&first.holds);
    let of_accelerometer = first.warnings.iter().filter(|stated| !stated_before.contains(stated));
    evidence.calibration.holds().into_iter().flat_map(left_out).chain(of_accelerometer.cloned()).collect()
}
