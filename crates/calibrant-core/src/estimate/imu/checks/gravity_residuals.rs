//! Gravity after the rotations, before and after the calibration.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// Is it missed by more than before?
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let calibration = evidence.calibration;
    let (after, before) = (calibration.rotation_rms_rad(), calibration.rotation_rms_before_rad());
    let words = || {
        format!(
            "gravity after a rotation is missed by more than before the calibration, {:.2}° in place of {:.2}°: something that was given does not fit the rotations",
            after.to_degrees(),
            before.to_degrees()
        )
    };
    (after > before).then(words).into_iter().collect()
}
