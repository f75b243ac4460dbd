//! Validation on a sheet: the errors of a calibration on data that it did not use, in sentences and a table.

use super::figure::validation_errors;
use crate::number_format::{counted, fixed, missed_angle, significant};
use crate::sheet::{Cell, Section, Table};
use calibrant_core::estimate::{
    BiasShift, Caveat, ClockRate, CovarianceVerdict, ErrorKind, FailedFold, LikelyExplanation, NoiseRatio,
    UnusedError, ValidatedErrors, Validation, ValidationSource,
};
use calibrant_core::sensor::SensorKind;

/// Largest number of errors that are named one by one. The others are counted.
const NAMED: usize = 5;
/// Errors beyond this factor have another cause than the covariance.
const OTHER_CAUSE: f64 = 30.0;

/// The result of a validation, with a verdict for each kind of error: is the covariance consistent with the errors?
#[must_use]
pub fn validation_sentences(validation: &Validation) -> Vec<String> {
    // a wrong unit explains noise and bias
    let in_unit = validation.reasons.iter().all(|of| !matches!(of, LikelyExplanation::AngularUnit { .. }));
    let other = validation.noise.iter().filter(|noise| noise.differs());
    let mut sentences: Vec<String> = other
        .filter(|noise| in_unit || noise.sensor_kind == SensorKind::Accelerometer)
        .map(other_noise)
        .collect();
    sentences.extend(validation.reasons.iter().map(likely_explanation));
    let explained =
        |errors: &ValidatedErrors| validation.reasons.iter().any(|reason| reason.explains(errors.kind));
    let beyond = |errors: &ValidatedErrors| {
        errors.verdict == CovarianceVerdict::TooSmall && errors.factor > OTHER_CAUSE && !explained(errors)
    };
    let any_beyond = validation.kinds.iter().any(beyond);
    // with another sensor or other axes, the bias has not moved
    sentences.extend(validation.bias_shift.as_ref().filter(|_| in_unit && !any_beyond).map(bias));
    for errors in &validation.kinds {
        let cause = match errors {
            _ if explained(errors) => Cause::Reported,
            _ if beyond(errors) => Cause::Another,
            _ if any_beyond => Cause::Beside,
            _ => Cause::Covariance,
        };
        sentences.push(sentence(errors, cause));
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

/// A line for each kind of error: its ratio, and what that says of the covariance.
pub(super) fn validation_in_short(validations: &[Validation]) -> Vec<String> {
    let line = |errors: &ValidatedErrors| {
        let says = match errors.verdict {
            CovarianceVerdict::Believed => "the covariance is consistent with the errors",
            CovarianceVerdict::LargerThanNeeded => "the standard deviations are too large",
            CovarianceVerdict::TooFew => "the data are too few for a verdict",
            CovarianceVerdict::Doubtful => "as predicted, but the errors confirm nothing",
            CovarianceVerdict::TooSmall => "the errors are larger than predicted",
        };
        format!(
            "{}: {} rms, {} predicted, ratio {}: {says}.",
            what(errors.kind),
            measured(errors.kind, errors.rms),
            measured(errors.kind, errors.predicted_rms),
            between(errors.factor, errors.factor_interval)
        )
    };
    validations.iter().flat_map(|validation| validation.kinds.iter().map(line)).collect()
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
            errors.caveat.as_ref().map_or_else(String::new, |caveat| why(caveat, errors))
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
    let end = if verdict.ends_with('?') { "" } else { "." };
    format!("{misses}. {verdict}{end}")
}

/// Why errors of the predicted size confirm nothing.
fn why(caveat: &Caveat, errors: &ValidatedErrors) -> String {
    let what = match errors.kind {
        ErrorKind::Magnitude | ErrorKind::Rate => "hold",
        ErrorKind::Rotation => "rotation",
    };
    let from_to = |start_s: f64, end_s: f64| format!("from {} to {} s", fixed(start_s, 1), fixed(end_s, 1));
    match caveat {
        Caveat::Change(change) => {
            format!("{}, and the prediction includes the scatter of this change", change.headline())
        }
        Caveat::Clocks(ClockRate { faster, sd }) => format!(
            "the clocks of the sensors run at different rates, by {:.4} ± {:.4} %. The gains are wrong by this percentage in all rotations alike",
            100.0 * faster.abs(),
            100.0 * sd
        ),
        Caveat::LeftOut { count, start_s, end_s } => format!(
            "the calibration did not use {count} in a row, {}. This is not by chance, and the calibration holds only for the others",
            from_to(*start_s, *end_s)
        ),
        Caveat::InARow { count, start_s, end_s } => format!(
            "{} in a row, {}, {} not counted. This is not by chance. Did the sensor change there?",
            counted(*count, what),
            from_to(*start_s, *end_s),
            if *count == 1 { "is" } else { "are" }
        ),
        Caveat::Several { count } => format!(
            "{} of {} are not counted, which is too many to be chance",
            counted(*count, what),
            errors.errors.len()
        ),
    }
}

fn other_noise(noise: &NoiseRatio) -> String {
    let ratio = significant(noise.overall(), 2);
    if let Some(coarse) = noise.coarse {
        return format!(
            "The {}'s readings come in steps of {} {} here, coarser than their noise (a wider range, or rounded?). They scatter {ratio} times as much as in the calibration's recording. \
             The prediction includes that. It is no reason to distrust the calibration.",
            noise.sensor_kind,
            significant(coarse.step, 2),
            coarse.unit.symbol()
        );
    }
    format!(
        "The {}'s noise is {} times that of the calibration's recording (another range, bandwidth or filter?). The prediction uses the noise of this recording. It is no reason to \
         distrust the calibration.",
        noise.sensor_kind, ratio
    )
}

fn likely_explanation(reason: &LikelyExplanation) -> String {
    let list = |values: &nalgebra::Vector3<f64>, scale: f64| {
        values.iter().map(|value| significant(scale * value, 2)).collect::<Vec<_>>().join(", ")
    };
    let most = |values: &nalgebra::Vector3<f64>, sd: &nalgebra::Vector3<f64>| {
        significant(values.component_div(sd).amax(), 2)
    };
    match reason {
        LikelyExplanation::Temperature { calibrated_c, here_c } => format!(
            "This recording was made at a mean of {} °C, the calibration at {} °C and without temperature terms. This is the likely cause of the differences. Calibrate over the temperatures of \
             use, with [temperature].",
            fixed(*here_c, 1),
            fixed(*calibrated_c, 1)
        ),
        LikelyExplanation::BeyondTemperatures { calibrated_c, here_c } => {
            let between = |[low, high]: &[f64; 2]| match high - low < 0.1 {
                true => fixed(*low, 1),
                false => format!("{} to {}", fixed(*low, 1), fixed(*high, 1)),
            };
            format!(
                "This recording was made at {} °C, the calibration at {} °C. The temperature terms are extrapolated, which is the likely cause of the differences. Calibrate over \
                 the temperatures of use.",
                between(here_c),
                between(calibrated_c)
            )
        }
        LikelyExplanation::AccelerometerBias { shift_mps2, sd_mps2 } => format!(
            "The accelerometer's bias has moved by {} mm/s² since the calibration, up to {} standard deviations. That explains the gravity residuals. Calibrate it again.",
            list(shift_mps2, 1e3),
            most(shift_mps2, sd_mps2)
        ),
        LikelyExplanation::AccelerometerGain { change, sd } => format!(
            "The accelerometer's gains have changed by {} % since the calibration, up to {} standard deviations. That explains the gravity residuals. Calibrate it again.",
            list(change, 100.0),
            most(change, sd)
        ),
        LikelyExplanation::AccelerometerBiasAndGain { shift_mps2, shift_sd_mps2, change, change_sd } => {
            format!(
                "Since the calibration the accelerometer's bias has moved by {} mm/s², up to {} standard deviations. Its gains have changed by {} %, up to {}. Both together explain the gravity \
             residuals. Calibrate it again.",
                list(shift_mps2, 1e3),
                most(shift_mps2, shift_sd_mps2),
                list(change, 100.0),
                most(change, change_sd)
            )
        }
        LikelyExplanation::GyroscopeGain { change, sd } => format!(
            "The gyroscope's gains have changed by {} % since the calibration (or its clock by as much), up to {} standard deviations. That explains the rotation errors. Calibrate it again.",
            list(change, 100.0),
            most(change, sd)
        ),
        LikelyExplanation::AngularUnit { factor } => {
            let (really, stated) = if *factor < 1.0 { ("deg/s", "rad/s") } else { ("rad/s", "deg/s") };
            format!(
                "The gyroscope's readings are 57.3 times too {}: they are likely in {really}, but stated in {stated}. In {really}, the propagated gravity is right.",
                if *factor < 1.0 { "large" } else { "small" }
            )
        }
    }
}

fn bias(shift: &BiasShift) -> String {
    if !shift.moved {
        return "The gyroscope's bias agrees with the calibration, within its uncertainty.".into();
    }
    let degrees = |value: f64| significant(value.to_degrees(), 2);
    let values: Vec<String> = shift.shift_radps.iter().map(|value| degrees(*value)).collect();
    let most = shift.shift_radps.component_div(&shift.sd_radps).amax();
    format!(
        "The gyroscope's bias has moved by {} °/s since the calibration, up to {} standard deviations. Estimate it again where the gyroscope is used. Rates and rotations are judged \
         with the new bias.",
        values.join(", "),
        significant(most, 2)
    )
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
