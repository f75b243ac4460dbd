//! Validation of a calibration on a machine, in sentences and a table.

use super::quantity::machine_unit;
use crate::number_format::{fixed, significant};
use crate::sheet::{Cell, Section, Table};
use crate::validation::between;
use calibrant_core::estimate::CovarianceVerdict;
use calibrant_machine::estimate::{
    LargestShift, MachineCalibration, MachineValidation, MachineValidationSource, ParameterShift,
};

/// Movements beyond this many times the predicted ones have another cause than the covariance.
const OTHER_CAUSE: f64 = 30.0;

/// What a validation is on.
fn heading(validation: &MachineValidation) -> String {
    match &validation.source {
        MachineValidationSource::Recording { name } => format!("On {name}"),
        MachineValidationSource::Blocks { folds, length_s, .. } => {
            format!("{folds} blocks of {} s, each left out in turn", significant(*length_s, 3))
        }
    }
}

/// A verdict for each sensor, and the blocks that cannot be left out.
fn sentences(validation: &MachineValidation) -> Vec<String> {
    let mut sentences: Vec<String> = validation.shifts.iter().map(sentence).collect();
    if validation.shifts.is_empty() {
        sentences.push("These data tell nothing: what is known beforehand outweighs them.".into());
    }
    if let MachineValidationSource::Blocks { failed, .. } = &validation.source {
        sentences.extend(failed.iter().map(|block| {
            let [start, end] = [block.start_s, block.end_s].map(|at| fixed(at, 1));
            format!("Without {start} to {end} s there is no calibration: {}.", block.reason)
        }));
    }
    sentences
}

fn sentence(shift: &ParameterShift) -> String {
    let what = format!("The parameters of the {}", shift.sensor);
    let two = |value: f64| significant(value, 2);
    match shift.verdict {
        CovarianceVerdict::Believed => format!("{what} move as far as their covariance predicts."),
        CovarianceVerdict::TooSmall if shift.factor > OTHER_CAUSE => format!(
            "{what} move {} times as far as predicted. No covariance explains that. Is it the same sensor on the same mount, with the same units and axes?",
            two(shift.factor)
        ),
        CovarianceVerdict::TooSmall => format!(
            "{what} move further than predicted: the covariance is too small. Multiply their standard deviations by about {}. \
             The machine does not move as its model and its log say.",
            two(shift.factor)
        ),
        CovarianceVerdict::LargerThanNeeded => format!(
            "{what} move less than predicted: the standard deviations are too large, by about {}.",
            two(shift.factor.recip())
        ),
        CovarianceVerdict::TooFew | CovarianceVerdict::Doubtful => {
            format!("{what}: the data are too few for a verdict.")
        }
    }
}

fn largest(
    largest: &LargestShift,
    source: &MachineValidationSource,
    calibration: &MachineCalibration,
) -> String {
    let (factor, unit) = machine_unit(calibration, largest.quantity);
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    let name = largest.quantity.name(&calibration.joints);
    let moved = format!(
        "{name} by {}{unit}, {} sd",
        significant(factor * largest.shift, 2),
        significant(largest.in_sd.abs(), 2)
    );
    match (source, largest.without_s) {
        (MachineValidationSource::Blocks { length_s, .. }, Some(start_s)) => {
            let [start, end] = [start_s, start_s + length_s].map(|at| fixed(at, 1));
            format!("{moved}, without {start} to {end} s")
        }
        _ => moved,
    }
}

/// A line for each sensor: what a validation says of its covariance.
pub(super) fn validation_in_short(validations: &[MachineValidation]) -> Vec<String> {
    let line = |shift: &ParameterShift| {
        format!("{} The ratio is {}.", sentence(shift), between(shift.factor, shift.factor_interval))
    };
    validations.iter().flat_map(|of| of.shifts.iter().map(line)).collect()
}

/// A section with all validations; none without any.
pub(super) fn validation_section<'a>(
    validations: &[MachineValidation],
    calibration: &MachineCalibration,
) -> Option<Section<'a>> {
    if validations.is_empty() {
        return None;
    }
    let mut section = Section::new("Validation").lead(
        "How far the parameters move with other data, beside what their covariance predicts. The ratio is √(χ²/degrees of freedom): 1 if the standard deviations are right.",
    );
    for validation in validations {
        section.subheading(heading(validation));
        section.list(sentences(validation));
        let columns = ["parameters of", "χ²", "degrees of freedom", "ratio (99 %)", "largest movement"];
        let mut table = Table::new(columns);
        for shift in &validation.shifts {
            table.row(vec![
                Cell::name(shift.sensor.to_string()),
                Cell::significant(shift.chi2, 3),
                Cell::Number(shift.degrees_of_freedom.to_string()),
                Cell::Number(between(shift.factor, shift.factor_interval)),
                Cell::Number(largest(&shift.largest, &validation.source, calibration)),
            ]);
        }
        section.table(table);
    }
    Some(section)
}
