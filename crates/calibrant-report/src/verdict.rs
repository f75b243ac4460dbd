//! The verdict on an accelerometer's calibration: can it be used?

use super::{About, html, number_format};
use crate::words::message;
use calibrant_core::estimate::{Calibration, CalibrationStatus, Recovered};

/// Below this, a probability counts as evidence against the model.
const SIGNIFICANT: f64 = 0.001;
/// A standard deviation above this share of the datasheet spread means that the recording determined little.
const HARDLY_DETERMINED: f64 = 0.5;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Grade {
    Good,
    Caution,
    Bad,
}

impl Grade {
    fn class(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Caution => "caution",
            Self::Bad => "bad",
        }
    }

    fn word(self) -> &'static str {
        match self {
            Self::Good => "✓ Usable.",
            Self::Caution => "! Look closer.",
            Self::Bad => "✗ Do not use without a look at the residuals.",
        }
    }
}

/// The verdict and everything that qualifies it, as one prominent box.
pub(super) fn verdict(calibration: &Calibration, about: &About) -> String {
    let (grade, sentence) = judge(calibration);
    let mut remarks = calibration.warnings.iter().map(message).collect::<Vec<_>>();
    remarks.extend(hardly_determined(calibration));
    let grade = if remarks.is_empty() { grade } else { grade.max(Grade::Caution) };
    let remarks = [("Warnings", remarks), ("About the recording", about.findings.clone())];
    html::verdict_box(grade.class(), grade.word(), &sentence, &remarks)
}

fn judge(calibration: &Calibration) -> (Grade, String) {
    let fit = &calibration.fit;
    let iterations = match calibration.iterations {
        1 => "1 iteration".to_string(),
        n => format!("{n} iterations"),
    };
    let (mut grade, mut sentence) = match calibration.status {
        CalibrationStatus::Converged => (Grade::Good, format!("The estimation converged in {iterations}")),
        CalibrationStatus::IterationLimit => (
            Grade::Bad,
            format!("The estimation stopped at its limit of {iterations} before it had converged"),
        ),
        CalibrationStatus::Stalled => (
            Grade::Bad,
            format!(
                "The estimation stalled after {iterations}: no step improved the fit although it had not converged"
            ),
        ),
    };
    match fit.p_value {
        Some(p) if p < SIGNIFICANT => {
            grade = grade.max(Grade::Caution);
            sentence.push_str(&format!(
                "; model and assumed noise do not explain the data (χ² p-value {}): the noise is larger than assumed, or the \
                 model misses something",
                number_format::probability(p)
            ));
        }
        Some(p) if p > 1.0 - SIGNIFICANT => {
            grade = grade.max(Grade::Caution);
            sentence.push_str(&format!(
                "; the residuals are smaller than the assumed noise allows (χ² p-value {}): the assumed noise is too large, and \
                 so are the stated standard deviations",
                number_format::probability(p)
            ));
        }
        Some(p) => {
            sentence.push_str(&format!(
                "; model and assumed noise explain the data (χ² p-value {})",
                number_format::probability(p)
            ));
        }
        None if fit.degrees_of_freedom == 0 => {
            grade = grade.max(Grade::Caution);
            sentence.push_str("; there are no more data than unknowns, so nothing checks the fit");
        }
        None => sentence.push_str("; the noise was estimated from this fit, so χ² cannot test it"),
    }
    let coloured = fit.whiteness.iter().filter(|test| test.p_value < SIGNIFICANT).count();
    if coloured > 0 {
        grade = grade.max(Grade::Caution);
        sentence.push_str(&format!(
            "; the residuals are not white on {coloured} of {} axes, so the stated standard deviations are too small",
            fit.whiteness.len()
        ));
    }
    if let Recovered::Holds(holds) = &calibration.recovered {
        let used = holds.holds.iter().filter(|hold| hold.used).count();
        sentence.push_str(&format!("; {used} of {} holds were used", holds.holds.len()));
    }
    sentence.push('.');
    (grade, sentence)
}

/// Parameters known little better than from the datasheet; those known worse have a warning of their own.
fn hardly_determined(calibration: &Calibration) -> Option<String> {
    let names: Vec<&str> = calibration
        .parameters
        .iter()
        .zip(calibration.sd())
        .filter(|(parameter, sd)| {
            parameter
                .spread
                .is_some_and(|spread| spread > 0.0 && (HARDLY_DETERMINED * spread..=spread).contains(sd))
        })
        .map(|(parameter, _)| parameter.name.as_str())
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "The data say little more than the datasheet about {}: the standard deviation is more than half the datasheet spread. \
             A motion that excites it more, or more data, would help.",
            names.join(", ")
        )
    })
}
