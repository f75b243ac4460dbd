//! Rotations that were left out.

use crate::diagnostic::gyroscope::{RotationLeftOut, RotationsLeftOutInARow};
use crate::diagnostic::{Changed, Diagnostic, RotationReason};
use crate::estimate::change::longest_run;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::estimate::imu::result::RotationResult;
use crate::estimate::result::Calibration;
use crate::sensor::SensorKind;

/// Each with its reason, and those that were left out one after another.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let calibration = evidence.calibration;
    let mut warnings = Vec::new();
    for rotation in calibration.rotations().iter().filter(|rotation| !rotation.used) {
        let is_integrated = rotation.is_integrated();
        warnings.push(
            RotationLeftOut {
                from_hold: rotation.from_hold + 1,
                to_hold: rotation.to_hold + 1,
                start_s: rotation.start_s,
                end_s: rotation.end_s,
                error_rad: is_integrated.then_some(rotation.error_rad),
                deviations: is_integrated.then_some(rotation.studentised),
                reason: rotation.reason.unwrap_or(RotationReason::Unfit),
            }
            .into(),
        );
    }
    warnings.extend(rotations_in_a_row(calibration));
    warnings
}

/// Rotations that were left out one after another, where no change explains them.
fn rotations_in_a_row(calibration: &Calibration) -> Option<Diagnostic> {
    let rotations: Vec<&RotationResult> =
        calibration.rotations().iter().filter(|rotation| rotation.is_integrated()).collect();
    let run = longest_run(rotations.iter().map(|rotation| !rotation.used))?;
    let explained = calibration
        .changes
        .iter()
        .any(|change| change.of != Changed::Bias || change.sensor_kind == SensorKind::Accelerometer);
    (!explained).then(|| {
        Diagnostic::from(RotationsLeftOutInARow {
            rotations: run.len(),
            start_s: rotations[run.start].start_s,
            end_s: rotations[run.end - 1].end_s,
        })
    })
}
