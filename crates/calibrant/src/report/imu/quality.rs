//! How good the calibration of an IMU is, in one sentence.

use crate::estimate::ImuCalibration;
use crate::report::number;

/// How well gravity is met after rotations, known turns and in holds: `after a rotation, gravity is met within 0.12° rms (3.4° before); …`.
#[must_use]
pub fn imu_quality(calibration: &ImuCalibration) -> String {
    let mut parts = Vec::new();
    if calibration.rotations.iter().any(|rotation| rotation.used) {
        parts.push(format!(
            "after a rotation, gravity is met within {} rms ({} before)",
            degrees(calibration.rotation_rms_rad()),
            degrees(calibration.rotation_rms_before_rad())
        ));
    }
    if !calibration.turns.is_empty() {
        let squares =
            calibration.turns.iter().map(|turn| (turn.measured_rad - turn.angle_rad).norm_squared());
        let rms = (squares.sum::<f64>() / calibration.turns.len() as f64).sqrt();
        parts.push(format!("known turns are met within {} rms", degrees(rms)));
    }
    parts.push(format!(
        "held still, the corrected magnitude is that of gravity within {} mm/s² rms",
        number::significant(1e3 * calibration.holds.magnitude_residual_rms_mps2, 2)
    ));
    parts.join("; ")
}

/// An angle in degrees to two digits.
pub(super) fn degrees(angle_rad: f64) -> String {
    format!("{}°", number::significant(angle_rad.to_degrees(), 2))
}
