//! Did the iteration converge?

use crate::diagnostic::Diagnostic;
use crate::diagnostic::fit::NotConverged;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};
use crate::solve::CalibrationStatus;

/// Nothing where it did.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let status = evidence.calibration.status;
    if status == CalibrationStatus::Converged {
        return Vec::new();
    }
    vec![Diagnostic::from(NotConverged { status: status.name() })]
}
