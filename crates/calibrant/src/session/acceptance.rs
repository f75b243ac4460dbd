//! The last stage: limits are checked, and the verdict is made.

use super::figures::figures;
use super::outcome::Outcome;
use calibrant_core::acceptance::{AcceptanceLimit, CheckedLimit, checked};
use calibrant_core::diagnostic::machine::{
    LogOutliers, MachineResiduals, MountGivesWay, ReferenceUndermodelled,
};
use calibrant_core::diagnostic::samples::Spikes;
use calibrant_core::diagnostic::validation::{FoldsAgree, ResidualsConfirmed, ValidationDoubts};
use calibrant_core::diagnostic::{Check, Code, Diagnostic, Phrase};
use calibrant_core::estimate::{CovarianceVerdict, ErrorKind, ValidatedErrors, Validation};
use calibrant_machine::estimate::{MachineValidationSource, ParameterShift};

/// Adds the limits, and the diagnostics of validations and limits, to an outcome. `findings`: what the reader noticed in its recording.
pub(crate) fn judge(outcome: &mut Outcome, limits: &[AcceptanceLimit], findings: Vec<Code>) {
    let limits = checked(limits, &figures(&outcome.calibrated, &outcome.validations));
    let mut found = doubts(&outcome.validations);
    found.extend(machine_doubts(outcome));
    if let Some((note, codes)) = confirmed(outcome) {
        found.push(note);
        outcome.allowed.extend(codes);
    }
    found.extend(limits.iter().filter_map(CheckedLimit::diagnostic));
    outcome.calibrated.sensors_mut().warnings.extend(found);
    (outcome.limits, outcome.findings) = (limits, findings);
    let verdict = outcome.verdict();
    outcome.about.verdict = Some(verdict);
    outcome.about.limits.clone_from(&outcome.limits);
}

/// What validations say against the covariance.
pub(crate) fn doubts(validations: &[Validation]) -> Vec<Diagnostic> {
    let of_errors = |errors: &ValidatedErrors| {
        let what = match errors.kind {
            ErrorKind::Magnitude => "the errors of |f|",
            ErrorKind::Rate => "the rates at rest",
            ErrorKind::Rotation => "the rotation errors",
        };
        let is_large = errors.verdict == CovarianceVerdict::TooSmall;
        is_large.then(|| Diagnostic::from(ValidationDoubts { what: what.into(), factor: errors.factor }))
    };
    validations.iter().flat_map(|of| &of.kinds).filter_map(of_errors).collect()
}

/// The same of validations on a machine.
fn machine_doubts(outcome: &Outcome) -> Vec<Diagnostic> {
    let of_shift = |shift: &ParameterShift| {
        let what = format!("the movements of the parameters of the {}", shift.sensor);
        let is_large = shift.verdict == CovarianceVerdict::TooSmall;
        is_large.then(|| Diagnostic::from(ValidationDoubts { what, factor: shift.factor }))
    };
    let on_machine = outcome.calibrated.machine().map_or(&[][..], |machine| &machine.validations);
    on_machine.iter().flat_map(|of| &of.shifts).filter_map(of_shift).collect()
}

/// What is left in the residuals, or was taken out, says that the standard deviations may not hold; they are widened by it, and another recording that finds
/// them large enough answers it.
const ANSWERED: [Code; 4] =
    [MachineResiduals::CODE, ReferenceUndermodelled::CODE, LogOutliers::CODE, Spikes::CODE];
/// A recording is at another speed if it is faster or slower by this factor: what moves with force or the square of the rate then differs by more.
const OTHER_SPEED: f64 = 4.0 / 3.0;

/// The warnings that another recording of a sensor on a machine answers, and the note that says so. Folds answer none: what all blocks share, they do not see.
fn confirmed(outcome: &Outcome) -> Option<(Diagnostic, Vec<Code>)> {
    let machine = outcome.calibrated.machine()?;
    let validations = || machine.validations.iter().filter(|of| !of.shifts.is_empty());
    let shifts = || validations().flat_map(|of| &of.shifts);
    let is_large_enough = |of: CovarianceVerdict| {
        matches!(of, CovarianceVerdict::Believed | CovarianceVerdict::LargerThanNeeded)
    };
    if !shifts().all(|shift| is_large_enough(shift.verdict)) {
        return None;
    }
    let factor = shifts().map(|shift| shift.factor).fold(0.0, f64::max);
    let found = |codes: &[Code]| -> Vec<Code> {
        let is_found = |code: &&Code| outcome.warnings().iter().any(|found| found.code() == **code);
        codes.iter().filter(is_found).copied().collect()
    };
    let names = |codes: &[Code]| codes.iter().map(ToString::to_string).collect();
    let other = validations().find_map(|of| match &of.source {
        MachineValidationSource::Recording { name } => Some((name, of.speed_ratio)),
        MachineValidationSource::Blocks { .. } => None,
    });
    let Some((name, speed_ratio)) = other else {
        let codes = found(&ANSWERED);
        let is_said = validations().next().is_some() && !codes.is_empty();
        return is_said.then(|| (FoldsAgree { codes: names(&codes), factor }.into(), Vec::new()));
    };
    let mut codes = found(&ANSWERED);
    if speed_ratio.ln().abs() >= OTHER_SPEED.ln() {
        codes.extend(found(&[MountGivesWay::CODE]));
    }
    (!codes.is_empty()).then(|| {
        let recording = Phrase(name.clone());
        (ResidualsConfirmed { codes: names(&codes), recording, factor, speed_ratio }.into(), codes)
    })
}
