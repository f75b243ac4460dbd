//! Holds that were left out, and what the accelerometer's own fit says.

use crate::diagnostic::Diagnostic;
use crate::estimate::holds::left_out;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::checks::gains;

/// By the parameters of the whole IMU, in place of what the static fit said of the same holds and parameters.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let first = evidence.accelerometer;
    let stated_before = left_out(&first.holds);
    let is_own =
        |stated: &&Diagnostic| !stated_before.contains(stated) && !gains::CODES.contains(&stated.code());
    let of_accelerometer = first.warnings.iter().filter(is_own);
    evidence.calibration.holds().into_iter().flat_map(left_out).chain(of_accelerometer.cloned()).collect()
}
