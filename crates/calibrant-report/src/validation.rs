//! Validation on a sheet: the errors of a calibration on data that it did not use, in sentences and a table.

use super::figure::validation_errors;
use crate::number_format::{counted, fixed, missed_angle, significant};
use crate::sheet::{Cell, Section, Table};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::estimate::{
    CovarianceVerdict, ErrorKind, FailedFold, UnusedError, ValidatedErrors, Validation, ValidationSource,
};

/// Largest number of errors that are named one by one. The others are counted.
const NAMED: usize = 5;

/// The result of a validation, with a verdict for each kind of error: is the covariance consistent with the errors?
#[must_use]
pub fn validation_sentences(validation: &Validation) -> Vec<String> {
    let remarks = validation.likely_explanations.iter().cloned().chain(validation.differences());
    let mut sentences: Vec<String> = remarks.map(|found| found.sentence()).collect();
    if validation.bias_shift.is_some_and(|shift| !shift.moved) {
        sentences.push("The gyroscope's bias agrees with the calibration, within its uncertainty.".into());
    }
    for errors in &validation.kinds {
        sentences.push(sentence(errors, cause(validation, errors)));
        let outlying: Vec<&UnusedError> = errors.outlying().collect();
        sentences.extend(outlying.iter().take(NAMED).map(|error| stands_out(errors.kind, error)));
        if outlying.len() > NAMED {
            sentences.push(match outlying.len() - NAMED {
                1 => "One more is not counted either.".into(),
                more => format!("{more} more are not counted either."),
            });
        }
    }
    if let ValidationSource::Folds { failed, .. } = &validation.source {
        sentences.extend(failed.iter().map(failure));
    }
    sentences
}

/// The data of the validation: `on other.csv`, `5 folds`.
fn heading(validation: &Validation) -> String {
    match &validation.source {
        ValidationSource::Recording { name } if name.is_empty() => "On another recording".into(),
        ValidationSource::Recording { name } => format!("On {name}"),
        ValidationSource::Folds { folds, .. } => {
            format!("{folds} blocks of holds, each predicted from the others")
        }
    }
}

/// Likely explanations, and a sentence for each kind of error: its ratio, and what that says of the covariance.
pub(super) fn validation_in_short(validations: &[Validation]) -> Vec<String> {
    let of = |validation: &Validation| -> Vec<String> {
        let kinds = validation.kinds.iter().map(|errors| sentence(errors, cause(validation, errors)));
        validation.likely_explanations.iter().map(Diagnostic::sentence).chain(kinds).collect()
    };
    validations.iter().flat_map(of).collect()
}

/// The section on all validations of a calibration. Without a validation there is no section.
pub(super) fn validation_section(validations: &[Validation]) -> Option<Section<'_>> {
    if validations.is_empty() {
        return None;
    }
    let mut section = Section::new("Validation").lead(
        "Errors on data that the calibration did not use, and the errors that it predicts. The prediction includes the covariance, the noise, and the scatter between holds and \
         rotations. The ratio is rms over prediction: 1 if the standard deviations are right. It has a 99 % confidence interval, for all rows together. Holds within 10° are one orientation, and share what the model misses there.",
    );
    for validation in validations {
        section.subheading(heading(validation));
        section.list(validation_sentences(validation));
        section.table(table(validation));
        section.figure(|| Some(validation_errors(validation)));
    }
    Some(section)
}

/// Errors, number, distinct orientations, rms, predicted, ratio and p-value of each kind, and of the part of the parameters.
fn table(validation: &Validation) -> Table {
    let columns = ["error of", "number", "distinct", "rms", "predicted", "unit", "ratio (99 %)", "p-value"];
    let mut table = Table::new(columns);
    for errors in &validation.kinds {
        let unit = unit(errors.kind);
        let bare = |value: f64| {
            let text = measured(errors.kind, value);
            Cell::Number(text.trim_end_matches(unit).trim_end().to_owned())
        };
        table.row(vec![
            Cell::name(what(errors.kind)),
            Cell::Number(errors.counted().to_string()),
            Cell::Number(errors.distinct.to_string()),
            bare(errors.rms),
            bare(errors.predicted_rms),
            Cell::unit(unit),
            Cell::Number(between(errors.factor, errors.factor_interval)),
            Cell::probability(errors.p_value),
        ]);
        if let Some(part) = errors.parameters {
            let mut row = vec![Cell::name("– through the parameters")];
            row.extend([(); 5].map(|()| Cell::Missing));
            row.push(Cell::Number(between(part.factor, part.factor_interval)));
            row.push(Cell::probability(part.p_value));
            table.row(row);
        }
    }
    table
}

fn unit(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::Magnitude => "mm/s²",
        ErrorKind::Rate => "°/s",
        ErrorKind::Rotation => "°",
    }
}

fn what(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::Magnitude => "|f| in holds",
        ErrorKind::Rate => "rate in holds",
        ErrorKind::Rotation => "gravity after rotations",
    }
}

fn measured(kind: ErrorKind, value: f64) -> String {
    match kind {
        ErrorKind::Magnitude => format!("{} mm/s²", significant(1e3 * value, 2)),
        ErrorKind::Rate => format!("{} °/s", significant(value.to_degrees(), 2)),
        ErrorKind::Rotation => missed_angle(value),
    }
}

/// A ratio with its interval.
pub(crate) fn between(factor: f64, (low, high): (f64, f64)) -> String {
    let two = |value: f64| significant(value, 2);
    let high = if high < 1e3 { two(high) } else { "∞".into() };
    format!("{} ({} to {high})", two(factor), two(low))
}

/// The cause of errors larger than predicted.
#[derive(Clone, Copy, PartialEq)]
enum Cause {
    /// A likely explanation that the report has already named.
    Reported,
    /// A cause that no covariance explains.
    Another,
    /// The same cause as for errors of another kind.
    Beside,
    Covariance,
}

fn cause(validation: &Validation, errors: &ValidatedErrors) -> Cause {
    match errors {
        _ if validation.explains(errors.kind) => Cause::Reported,
        _ if validation.is_beyond(errors) => Cause::Another,
        _ if validation.kinds.iter().any(|errors| validation.is_beyond(errors)) => Cause::Beside,
        _ => Cause::Covariance,
    }
}

fn sentence(errors: &ValidatedErrors, cause: Cause) -> String {
    let (kind, count) = (errors.kind, errors.counted());
    let (rms, predicted) = (measured(kind, errors.rms), measured(kind, errors.predicted_rms));
    let (item, error) = match kind {
        ErrorKind::Magnitude => ("unused hold", "the gravity residual"),
        ErrorKind::Rate => ("unused hold", "the error of the corrected rate"),
        ErrorKind::Rotation => ("unused rotation", "the rotation error"),
    };
    let repeated = if errors.distinct < count {
        format!(", {} of them distinct", errors.distinct)
    } else {
        String::new()
    };
    let ratio = between(errors.factor, errors.factor_interval);
    let misses = format!(
        "In {}{repeated}, {error} is {rms} rms, predicted {predicted}: the ratio is {ratio}",
        counted(count, item)
    );
    let two = |value: f64| significant(value, 2);
    let verdict = match (errors.verdict, errors.parameters) {
        (CovarianceVerdict::Believed, _) => "The covariance is consistent with the errors".into(),
        (CovarianceVerdict::LargerThanNeeded, _) => {
            format!("The standard deviations are too large, by about {}", two(1.0 / errors.factor))
        }
        (CovarianceVerdict::TooFew, _) => "The data are too few for a verdict".into(),
        (CovarianceVerdict::Doubtful, _) => format!(
            "The errors are as predicted, but they confirm nothing: {}",
            errors.caveat.as_ref().map_or("", Diagnostic::message)
        ),
        (CovarianceVerdict::TooSmall, _) if cause == Cause::Reported => {
            "The cause named above is more likely than the covariance".into()
        }
        (CovarianceVerdict::TooSmall, _) if cause == Cause::Beside => {
            "The errors do not judge the covariance, since no covariance explains the other errors".into()
        }
        (CovarianceVerdict::TooSmall, _) if cause == Cause::Another => {
            "No covariance explains that. Is it the same sensor, with the same units and axes? Was it changed or damaged since?".into()
        }
        (CovarianceVerdict::TooSmall, Some(part)) if errors.factor_interval.0 <= 1.0 => format!(
            "But the part of the errors that the parameters cause is {} times the predicted part. The parameters' covariance is too small. Multiply their \
             standard deviations by about that (factor {})",
            two((part.chi2 / part.degrees_of_freedom as f64).sqrt()),
            between(part.factor, part.factor_interval)
        ),
        (CovarianceVerdict::TooSmall, _) => format!(
            "The covariance is too small. Multiply the standard deviations by about {}",
            two(errors.factor)
        ),
    };
    let end = if verdict.ends_with(['?', '.']) { "" } else { "." };
    format!("{misses}. {verdict}{end}")
}

fn stands_out(kind: ErrorKind, error: &UnusedError) -> String {
    let name = match error.from_hold {
        Some(from) => format!("The rotation from hold {} to hold {}", from + 1, error.hold + 1),
        None => format!("Hold {}", error.hold + 1),
    };
    let has = match kind {
        ErrorKind::Rate => "has a rate error of",
        ErrorKind::Magnitude => "has a gravity residual of",
        ErrorKind::Rotation => "has an error of",
    };
    format!(
        "{name} ({} to {} s) {has} {}, {} times the predicted one. It is not counted.",
        fixed(error.start_s, 1),
        fixed(error.end_s, 1),
        measured(kind, error.error.norm()),
        significant(error.in_sd, 2)
    )
}

fn failure(fold: &FailedFold) -> String {
    let (first, last) = (fold.holds.0 + 1, fold.holds.1 + 1);
    let holds = if first == last { format!("Hold {first}") } else { format!("Holds {first} to {last}") };
    format!("{holds} could not be predicted from the other holds: {}.", fold.reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(factor: f64, rms: f64) -> ValidatedErrors {
        ValidatedErrors {
            kind: ErrorKind::Rotation,
            errors: Vec::new(),
            distinct: 0,
            rms,
            predicted_rms: 1727.3,
            chi2: 1.0,
            degrees_of_freedom: 1,
            p_value: 0.0,
            factor,
            factor_interval: (0.9 * factor, 1.1 * factor),
            parameters: None,
            verdict: CovarianceVerdict::TooSmall,
            caveat: None,
        }
    }

    #[test]
    fn a_question_has_no_full_stop_and_an_angle_ends_at_half_a_revolution() {
        let stated = sentence(&errors(100.0, 1.0), Cause::Another);
        assert!(stated.ends_with("or damaged since?"), "{stated}");
        assert!(
            stated.contains("the rotation error is 57° rms, predicted more than 180°: the ratio is 100"),
            "{stated}"
        );
        let stated = sentence(&errors(3.0, 98_966_f64.to_radians()), Cause::Covariance);
        assert!(stated.ends_with("the standard deviations by about 3.0."), "{stated}");
        assert!(stated.contains("the rotation error is more than 180° rms"), "{stated}");
    }
}
