//! The last stage: limits are checked, and the verdict is made.

use super::calibrated::Calibrated;
use super::figures::figures;
use super::outcome::Outcome;
use calibrant_core::acceptance::{AcceptanceLimit, CheckedLimit, checked};
use calibrant_core::diagnostic::validation::ValidationDoubts;
use calibrant_core::diagnostic::{Code, Diagnostic};
use calibrant_core::estimate::{CovarianceVerdict, ErrorKind, ValidatedErrors};

/// Adds the limits, and the diagnostics of validations and limits, to an outcome. `findings`: what the reader noticed in its recording.
pub(crate) fn judge(outcome: &mut Outcome, limits: &[AcceptanceLimit], findings: Vec<Code>) {
    let limits = checked(limits, &figures(&outcome.calibrated, &outcome.validations));
    let mut found = doubts(outcome);
    found.extend(limits.iter().filter_map(CheckedLimit::diagnostic));
    match &mut outcome.calibrated {
        Calibrated::Sensors(calibration) => calibration.warnings.extend(found),
        Calibrated::OnMachine(machine) => machine.calibration.warnings.extend(found),
    }
    (outcome.limits, outcome.findings) = (limits, findings);
    let verdict = outcome.verdict();
    outcome.about.verdict = Some(verdict);
    outcome.about.limits.clone_from(&outcome.limits);
}

/// What validations say against the covariance.
fn doubts(outcome: &Outcome) -> Vec<Diagnostic> {
    let of_errors = |errors: &ValidatedErrors| {
        let what = match errors.kind {
            ErrorKind::Magnitude => "the errors of |f|",
            ErrorKind::Rate => "the rates at rest",
            ErrorKind::Rotation => "the rotation errors",
        };
        let is_large = errors.verdict == CovarianceVerdict::TooSmall;
        is_large.then(|| Diagnostic::from(ValidationDoubts { what: what.into(), factor: errors.factor }))
    };
    match &outcome.calibrated {
        Calibrated::Sensors(_) => {
            outcome.validations.iter().flat_map(|of| &of.kinds).filter_map(of_errors).collect()
        }
        Calibrated::OnMachine(machine) => {
            let shifts = machine.validations.iter().flat_map(|of| &of.shifts);
            let large = shifts.filter(|shift| shift.verdict == CovarianceVerdict::TooSmall);
            large
                .map(|shift| {
                    Diagnostic::from(ValidationDoubts {
                        what: format!("the movements of the parameters of the {}", shift.sensor),
                        factor: shift.factor,
                    })
                })
                .collect()
        }
    }
}
