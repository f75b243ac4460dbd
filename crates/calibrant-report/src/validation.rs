//! Validation in a report: the errors of a calibration on data that it did not use, in sentences and tables.

use super::figure::validation_errors;
use super::html::{Page, list};
use super::number_format;
use super::table::{Cell, Table};
use crate::words::headline;
use calibrant_core::estimate::{
    BiasShift, Caveat, ClockRate, CovarianceVerdict, ErrorKind, FailedFold, LikelyExplanation, NoiseRatio,
    UnusedError, ValidatedErrors, Validation, ValidationSource,
};
use calibrant_core::sensor::SensorKind;

/// Number of errors that are named one by one; the others are counted.
const NAMED: usize = 5;
/// Beyond this factor, the covariance is not the reason.
const ANOTHER: f64 = 30.0;

/// The result of a validation, a sentence for each kind of error: do the errors agree with the covariance?
#[must_use]
pub fn validation_sentences(validation: &Validation) -> Vec<String> {
    // in another unit, noise and bias are those of the unit
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
        errors.verdict == CovarianceVerdict::TooSmall && errors.factor > ANOTHER && !explained(errors)
    };
    let any_beyond = validation.kinds.iter().any(beyond);
    // with another sensor, or another order of the axes, the bias has not moved
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
                1 => "One more does not count either.".into(),
                more => format!("{more} more do not count either."),
            });
        }
    }
    if let ValidationSource::Folds { failed, .. } = &validation.source {
        sentences.extend(failed.iter().map(failure));
    }
    sentences
}

/// The data of the validation: `on other.csv`, `5 folds`.
#[must_use]
pub fn validation_heading(validation: &Validation) -> String {
    match &validation.source {
        ValidationSource::Recording { name } if name.is_empty() => "On another recording".into(),
        ValidationSource::Recording { name } => format!("On {name}"),
        ValidationSource::Folds { folds, .. } => {
            format!("{folds} blocks of holds, each predicted from the others")
        }
    }
}

/// Header and rows of what a validation found: errors, number, rms, predicted, χ² of n, p-value, factor.
#[must_use]
pub fn validation_rows(validation: &Validation) -> ([&'static str; 7], Vec<[String; 7]>) {
    let header = ["error of", "number", "rms", "predicted", "χ² of n", "p-value", "factor (99 %)"];
    let mut rows = Vec::new();
    for errors in &validation.kinds {
        let chi2 =
            |chi2: f64, degrees: usize| format!("{} of {degrees}", number_format::significant(chi2, 3));
        rows.push([
            what(errors.kind).into(),
            errors.counted().to_string(),
            measured(errors.kind, errors.rms),
            measured(errors.kind, errors.predicted_rms),
            chi2(errors.chi2, errors.degrees_of_freedom),
            number_format::probability(errors.p_value),
            between(errors.factor, errors.factor_interval),
        ]);
        if let Some(part) = errors.parameters {
            rows.push([
                "– by the parameters".into(),
                number_format::UNKNOWN.into(),
                number_format::UNKNOWN.into(),
                number_format::UNKNOWN.into(),
                chi2(part.chi2, part.degrees_of_freedom),
                number_format::probability(part.p_value),
                between(part.factor, part.factor_interval),
            ]);
        }
    }
    (header, rows)
}

/// The section on all validations of a calibration; nothing where there is none.
pub(super) fn validation_section(page: &mut Page, validations: &[Validation]) {
    if validations.is_empty() {
        return;
    }
    page.section(
        "Validation",
        "Errors on data that were not used, beside what the calibration predicts of them: its covariance, the noise, and the scatter between holds and \
         rotations. The factor is that by which the standard deviations are off, 1 if they are right, with its 99 % confidence interval.",
    );
    for validation in validations {
        page.subsection(&validation_heading(validation));
        page.push(list(&validation_sentences(validation)));
        let (header, rows) = validation_rows(validation);
        let mut table = Table::new("", &header);
        for row in rows {
            let [name, numbers @ ..] = row;
            let mut cells = vec![Cell::Name(name)];
            cells.extend(numbers.map(Cell::Number));
            table.row(cells);
        }
        page.push(table.html());
        page.push(validation_errors(validation).html());
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
        ErrorKind::Magnitude => format!("{} mm/s²", number_format::significant(1e3 * value, 2)),
        ErrorKind::Rate => format!("{} °/s", number_format::significant(value.to_degrees(), 2)),
        ErrorKind::Rotation => number_format::missed_angle(value),
    }
}

fn between(factor: f64, (low, high): (f64, f64)) -> String {
    let two = |value: f64| number_format::significant(value, 2);
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
    let misses = match kind {
        ErrorKind::Magnitude => {
            format!("On {} not used, |f| misses gravity by {rms} rms", count_that_were(count, "hold"))
        }
        ErrorKind::Rate => {
            format!("In {} not used, the corrected rate is off by {rms} rms", count_that_were(count, "hold"))
        }
        ErrorKind::Rotation => {
            format!("After {} not used, gravity is missed by {rms} rms", count_that_were(count, "rotation"))
        }
    };
    let two = |value: f64| number_format::significant(value, 2);
    let (low, high) = errors.factor_interval;
    let caveat = match (errors.verdict, errors.parameters) {
        (CovarianceVerdict::Believed, _) => {
            format!("the covariance is to be believed (the factor is between {} and {})", two(low), two(high))
        }
        (CovarianceVerdict::LargerThanNeeded, _) => format!(
            "{} times what was predicted: the standard deviations are larger than need be (the factor is between {} and {})",
            two(errors.factor),
            two(low),
            two(high)
        ),
        (CovarianceVerdict::TooFew, _) => {
            format!("too few to tell (the factor is anywhere between {} and {})", two(low), two(high))
        }
        (CovarianceVerdict::Doubtful, _) => format!(
            "as predicted (the factor is between {} and {}), but not to be believed: {}",
            two(low),
            two(high),
            errors.caveat.as_ref().map_or_else(String::new, |caveat| why(caveat, errors))
        ),
        (CovarianceVerdict::TooSmall, _) if cause == Cause::Reported => format!(
            "{} times what was predicted; the reason that is told above is a likelier one than the covariance",
            two(errors.factor)
        ),
        (CovarianceVerdict::TooSmall, _) if cause == Cause::Beside => format!(
            "{} times what was predicted; where other errors are beyond any covariance, it is not to be judged by these",
            two(errors.factor)
        ),
        (CovarianceVerdict::TooSmall, _) if cause == Cause::Another => format!(
            "{} times what was predicted, which no covariance explains: is it the same sensor, in the same units, its axes in the same order, and nothing changed or damaged \
             since?",
            two(errors.factor)
        ),
        (CovarianceVerdict::TooSmall, Some(part)) if low <= 1.0 => format!(
            "but what the errors have in common through the parameters is {} times what was predicted: the parameters' covariance is too small; multiply their \
             standard deviations by about that (factor {})",
            two((part.chi2 / part.degrees_of_freedom as f64).sqrt()),
            between(part.factor, part.factor_interval)
        ),
        (CovarianceVerdict::TooSmall, _) => format!(
            "{} times what was predicted: the covariance is too small; multiply the standard deviations by about {} (between {} and {})",
            two(errors.factor),
            two(errors.factor),
            two(low),
            two(high)
        ),
    };
    let end = if caveat.ends_with('?') { "" } else { "." };
    format!("{misses}, {predicted} predicted: {caveat}{end}")
}

fn count_that_were(count: usize, what: &str) -> String {
    format!("{} that {}", number_format::counted(count, what), if count == 1 { "was" } else { "were" })
}

/// Why errors as large as predicted confirm nothing.
fn why(caveat: &Caveat, errors: &ValidatedErrors) -> String {
    let what = match errors.kind {
        ErrorKind::Magnitude | ErrorKind::Rate => "hold",
        ErrorKind::Rotation => "rotation",
    };
    let from_to = |start_s: f64, end_s: f64| {
        format!("from {} to {} s", number_format::fixed(start_s, 1), number_format::fixed(end_s, 1))
    };
    match caveat {
        Caveat::Change(change) => {
            format!("{}, and what is predicted has the scatter in it that this makes", headline(change))
        }
        Caveat::Clocks(ClockRate { faster, sd }) => format!(
            "the clocks of the sensors go at different rates, by {:.4} ± {:.4} %: gains are wrong by this share in all rotations alike",
            100.0 * faster.abs(),
            100.0 * sd
        ),
        Caveat::LeftOut { count, start_s, end_s } => format!(
            "the calibration left out {count} in a row, {}, which is no chance, and speaks for the others only",
            from_to(*start_s, *end_s)
        ),
        Caveat::InARow { count, start_s, end_s } => format!(
            "{} in a row, {}, {} not count, which is no chance: did the sensor change there?",
            number_format::counted(*count, what),
            from_to(*start_s, *end_s),
            if *count == 1 { "does" } else { "do" }
        ),
        Caveat::Several { count } => format!(
            "{} of {} do not count, too many for a chance",
            number_format::counted(*count, what),
            errors.errors.len()
        ),
    }
}

fn other_noise(noise: &NoiseRatio) -> String {
    let ratio = number_format::significant(noise.overall(), 2);
    if let Some(coarse) = noise.coarse {
        return format!(
            "The {}'s readings come in steps of {} {} here, coarser than their noise (a wider range, or rounded?): they scatter {ratio} times as in the calibration's recording. What is \
             predicted goes with that, which is no reason to distrust the calibration.",
            noise.sensor_kind,
            number_format::significant(coarse.step, 2),
            coarse.unit.symbol()
        );
    }
    format!(
        "The {}'s noise is {} times that of the calibration's recording (another range, bandwidth or filter?): what is predicted goes with the noise found here, which is no reason to \
         distrust the calibration.",
        noise.sensor_kind, ratio
    )
}

fn likely_explanation(reason: &LikelyExplanation) -> String {
    let list = |values: &nalgebra::Vector3<f64>, scale: f64| {
        values.iter().map(|value| number_format::significant(scale * value, 2)).collect::<Vec<_>>().join(", ")
    };
    let most = |values: &nalgebra::Vector3<f64>, sd: &nalgebra::Vector3<f64>| {
        number_format::significant(values.component_div(sd).amax(), 2)
    };
    match reason {
        LikelyExplanation::Temperature { calibrated_c, here_c } => format!(
            "This recording was made at {} °C in the mean, the calibration at {} °C and without temperature terms: what differs has its likely reason in that. Calibrate over the temperatures of \
             use, with [temperature].",
            number_format::fixed(*here_c, 1),
            number_format::fixed(*calibrated_c, 1)
        ),
        LikelyExplanation::BeyondTemperatures { calibrated_c, here_c } => {
            let between = |[low, high]: &[f64; 2]| match high - low < 0.1 {
                true => number_format::fixed(*low, 1),
                false => format!("{} to {}", number_format::fixed(*low, 1), number_format::fixed(*high, 1)),
            };
            format!(
                "This recording was made at {} °C, the calibration at {} °C: beyond these its temperature terms are extrapolated, and what differs has its likely reason in that. Calibrate over \
                 the temperatures of use.",
                between(here_c),
                between(calibrated_c)
            )
        }
        LikelyExplanation::AccelerometerBias { shift_mps2, sd_mps2 } => format!(
            "The accelerometer's bias has moved by {} mm/s² since the calibration, up to {} standard deviations; that explains how |f| misses gravity. Calibrate it again.",
            list(shift_mps2, 1e3),
            most(shift_mps2, sd_mps2)
        ),
        LikelyExplanation::AccelerometerGain { change, sd } => format!(
            "The accelerometer's gains have changed by {} % since the calibration, up to {} standard deviations; that explains how |f| misses gravity. Calibrate it again.",
            list(change, 100.0),
            most(change, sd)
        ),
        LikelyExplanation::AccelerometerBiasAndGain { shift_mps2, shift_sd_mps2, change, change_sd } => {
            format!(
                "Since the calibration the accelerometer's bias has moved by {} mm/s², up to {} standard deviations, and its gains have changed by {} %, up to {}; both together explain how |f| misses \
             gravity. Calibrate it again.",
                list(shift_mps2, 1e3),
                most(shift_mps2, shift_sd_mps2),
                list(change, 100.0),
                most(change, change_sd)
            )
        }
        LikelyExplanation::GyroscopeGain { change, sd } => format!(
            "The gyroscope's gains have changed by {} % since the calibration (or its clock by as much), up to {} standard deviations; that explains how rotations miss gravity. Calibrate it again.",
            list(change, 100.0),
            most(change, sd)
        ),
        LikelyExplanation::AngularUnit { factor } => {
            let (really, stated) = if *factor < 1.0 { ("deg/s", "rad/s") } else { ("rad/s", "deg/s") };
            format!(
                "The gyroscope's readings are 57.3 times too {}: they are likely in {really}, and stated to be in {stated}. In {really} gravity is carried rightly.",
                if *factor < 1.0 { "large" } else { "small" }
            )
        }
    }
}

fn bias(shift: &BiasShift) -> String {
    if !shift.moved {
        return "The gyroscope's bias is that of the calibration, within its uncertainty.".into();
    }
    let degrees = |value: f64| number_format::significant(value.to_degrees(), 2);
    let values: Vec<String> = shift.shift_radps.iter().map(|value| degrees(*value)).collect();
    let most = shift.shift_radps.component_div(&shift.sd_radps).amax();
    format!(
        "The gyroscope's bias has moved by {} °/s since the calibration, up to {} standard deviations: determine it anew where it is used. Rates and rotations are judged \
         with the bias it has moved to.",
        values.join(", "),
        number_format::significant(most, 2)
    )
}

fn stands_out(kind: ErrorKind, error: &UnusedError) -> String {
    let name = match error.from_hold {
        Some(from) => format!("The rotation from hold {} to hold {}", from + 1, error.hold + 1),
        None => format!("Hold {}", error.hold + 1),
    };
    let missed = match kind {
        ErrorKind::Rate => "shows a rate of",
        ErrorKind::Magnitude | ErrorKind::Rotation => "misses gravity by",
    };
    format!(
        "{name} ({} to {} s) {missed} {}, {} times what was predicted, and does not count.",
        number_format::fixed(error.start_s, 1),
        number_format::fixed(error.end_s, 1),
        measured(kind, error.error.norm()),
        number_format::significant(error.in_sd, 2)
    )
}

fn failure(fold: &FailedFold) -> String {
    let (first, last) = (fold.holds.0 + 1, fold.holds.1 + 1);
    let holds = if first == last { format!("Hold {first}") } else { format!("Holds {first} to {last}") };
    format!("{holds} could not be predicted from the others: {}.", fold.reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(factor: f64, rms: f64) -> ValidatedErrors {
        ValidatedErrors {
            kind: ErrorKind::Rotation,
            errors: Vec::new(),
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
        assert!(stated.contains("gravity is missed by 57° rms, more than 180° predicted: "), "{stated}");
        let stated = sentence(&errors(3.0, 98_966_f64.to_radians()), Cause::Covariance);
        assert!(stated.ends_with("(between 2.7 and 3.3)."), "{stated}");
        assert!(stated.contains("gravity is missed by more than 180° rms"), "{stated}");
    }
}
