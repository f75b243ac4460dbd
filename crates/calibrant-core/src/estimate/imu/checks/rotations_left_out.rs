//! Rotations that were left out.

use crate::estimate::change::{Changed, longest_run};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::result::{ImuCalibration, RotationResult};
use crate::sensor::SensorKind;

/// Each with its reason, and those that were left out one after another.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let calibration = evidence.calibration;
    let mut warnings = Vec::new();
    for rotation in calibration.rotations.iter().filter(|rotation| !rotation.used) {
        let reason = rotation.reason.as_deref().unwrap_or("it does not fit");
        warnings.push(format!(
            "the rotation from hold {} to hold {} ({:.1} to {:.1} s) was left out: {reason}",
            rotation.from_hold + 1,
            rotation.to_hold + 1,
            rotation.start_s,
            rotation.end_s
        ));
    }
    warnings.extend(rotations_in_a_row(calibration));
    warnings
}

/// Rotations that were left out one after another, where no change explains them.
fn rotations_in_a_row(calibration: &ImuCalibration) -> Option<String> {
    let rotations: Vec<&RotationResult> =
        calibration.rotations.iter().filter(|rotation| rotation.is_integrated()).collect();
    let run = longest_run(rotations.iter().map(|rotation| !rotation.used))?;
    let explained = calibration
        .changes
        .iter()
        .any(|change| change.of != Changed::Bias || change.sensor_kind == SensorKind::Accelerometer);
    (!explained).then(|| {
        format!(
            "the {} rotations from {:.1} to {:.1} s were left out one after another, which is no chance: did the gyroscope saturate there, or one of the sensors change?",
            run.len(),
            rotations[run.start].start_s,
            rotations[run.end - 1].end_s
        )
    })
}
