//! Gravity after the rotations, before and after the calibration.

use crate::diagnostic::Diagnostic;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// Is it missed by more than before?
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let calibration = evidence.calibration;
    let (after, before) = (calibration.rotation_rms_rad(), calibration.rotation_rms_before_rad());
    let missed = Diagnostic::GravityMissedMore { after_rad: after, before_rad: before };
    (after > before).then_some(missed).into_iter().collect()
}
