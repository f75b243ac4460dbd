//! What a user should know of a result on a machine.

use super::{MachineCalibration, MachineProblem};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::estimate::CalibrationStatus;

/// All of it, the most important first.
pub(super) fn all(_problem: &MachineProblem<'_>, calibration: &MachineCalibration) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    if calibration.status != CalibrationStatus::Converged {
        found.push(Diagnostic::NotConverged { status: calibration.status.name() });
    }
    found
}
