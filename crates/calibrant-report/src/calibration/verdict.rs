//! The verdict on a calibration: can it be used?

use super::quality::{calibration_quality, uncertain_gravity, used_in_words};
use crate::About;
use crate::number_format::{capitalised, percent};
use crate::sheet::{Grade, SheetVerdict};
use crate::validation::validation_in_short;
use calibrant_core::diagnostic::{Diagnostic, Severity, Usability, Verdict};
use calibrant_core::estimate::Calibration;
use calibrant_core::sensor::{Axis, ImuQuantity, Invariant, InvariantValue, Quantity, SensorKind};

/// A standard deviation above this share of the datasheet spread means that the recording determined little.
const HARDLY_DETERMINED: f64 = 0.5;
/// Above this share of the prior in its information, a parameter is more prior knowledge than data.
const MOSTLY_PRIOR: f64 = 0.5;
/// The calibration must lower the rotation errors to this factor or less; otherwise it has not explained
/// them.
const IMPROVED: f64 = 0.8;

pub(super) fn verdict(calibration: &Calibration, about: &About) -> SheetVerdict {
    let remarks = (not_improved(calibration).into_iter())
        .chain(hardly_determined(calibration))
        .chain(mostly_prior(calibration))
        .chain(unchecked(calibration));
    let validation = validation_in_short(&about.validations);
    calibration_verdict(&calibration.warnings, remarks, validation, &sentence(calibration), about)
}

/// The verdict with its errors, warnings, further remarks and the validation in short; with a sentence on what was calibrated.
pub(crate) fn calibration_verdict(
    diagnostics: &[Diagnostic],
    remarks: impl IntoIterator<Item = String>,
    validation: Vec<String>,
    sentence: &str,
    about: &About,
) -> SheetVerdict {
    let of = |severity: Severity| -> Vec<String> {
        diagnostics
            .iter()
            .filter(|found| found.severity() == severity)
            .map(|found| found.message().to_owned())
            .collect()
    };
    let remarks: Vec<String> = of(Severity::Note).into_iter().chain(remarks).collect();
    let own = || Verdict::on(diagnostics.iter().map(Diagnostic::code), &[]);
    let verdict = about.verdict.clone().unwrap_or_else(own);
    let (grade, word) = match (verdict.usability, remarks.is_empty()) {
        (Usability::Ok, true) => (Grade::Good, "✓ Usable.".to_owned()),
        (Usability::Ok, false) => (Grade::Good, "✓ Usable; read the remarks.".to_owned()),
        (Usability::Doubtful, _) => (Grade::Caution, "! Doubtful: read the warnings first.".to_owned()),
        (Usability::Bad, _) => {
            (Grade::Bad, format!("✗ Bad: do not use ({}).", verdict.code_names().join(", ")))
        }
    };
    SheetVerdict::new(grade, word, sentence)
        .with("Errors", of(Severity::Error))
        .with("Warnings", of(Severity::Warning))
        .with("Remarks", remarks)
        .with("Validation", validation)
        .with("About the recording", about.findings.clone())
        .on_terminal(format!("verdict: {verdict}"))
}

fn sentence(calibration: &Calibration) -> String {
    let sensors = match calibration.gyroscope {
        None => "The accelerometer was calibrated",
        Some(_) => "Accelerometer and gyroscope were calibrated together,",
    };
    let quality = match calibration_quality(calibration).join("; ") {
        quality if quality.is_empty() => String::new(),
        quality => capitalised(&quality) + ". ",
    };
    let gravity =
        uncertain_gravity(calibration).map_or_else(String::new, |words| format!(" {}.", capitalised(&words)));
    format!("{sensors} from {}. {quality}{}.{gravity}", used_in_words(calibration), gains(calibration))
}

/// The relative standard deviation of each sensor's gains, on the worst axis.
fn gains(calibration: &Calibration) -> String {
    if calibration.axes() == 1 {
        let scale = ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Scale(Axis::X));
        let place = calibration.quantities.iter().position(|quantity| *quantity == scale);
        let share = place.map_or(f64::NAN, |k| calibration.sd()[k] / calibration.values[k].abs());
        return format!("The gain is known to {}, one standard deviation", percent(share));
    }
    let invariants = calibration.calibrated().invariants();
    let of_sensor = |&sensor_kind: &SensorKind| {
        let worst = percent(worst_gain(&invariants, sensor_kind));
        if calibration.gyroscope.is_some() { format!("{worst} ({sensor_kind})") } else { worst }
    };
    let known: Vec<String> = calibration.sensor_kinds().iter().map(of_sensor).collect();
    format!("The gains are known to {}, one standard deviation on the worst axis", known.join(" and "))
}

/// The largest relative standard deviation of a sensor's gains; 0 where none is known.
pub(crate) fn worst_gain(invariants: &[InvariantValue], sensor: SensorKind) -> f64 {
    let of_sensor =
        |found: &&InvariantValue| matches!(found.invariant, Invariant::Gain(of, _) if of == sensor);
    let known = invariants.iter().filter(of_sensor).filter_map(|found| Some(found.sd? / found.value));
    known.fold(0.0, f64::max)
}

fn not_improved(calibration: &Calibration) -> Option<String> {
    let (after, before) = (calibration.rotation_rms_rad(), calibration.rotation_rms_before_rad());
    (after > IMPROVED * before).then(|| {
        "The calibration hardly improves the rotations. Either the gyroscope was good before, or the rotation errors have another cause: \
         saturation, a delay between the sensors, or a sample rate that is too low."
            .to_string()
    })
}

/// The names of the parameters that this holds for, by their places; `None` where there are none.
fn names(calibration: &Calibration, of: impl Fn(usize) -> bool) -> Option<String> {
    let chosen = (0..calibration.parameters.len()).filter(|&k| of(k));
    let names: Vec<&str> = chosen.map(|k| calibration.parameters[k].name.as_str()).collect();
    (!names.is_empty()).then(|| names.join(", "))
}

/// Parameters that are known little better than from the datasheet. Parameters that are known worse have a warning.
fn hardly_determined(calibration: &Calibration) -> Option<String> {
    let sd = calibration.sd();
    let within = |k: usize, spread: f64| (HARDLY_DETERMINED * spread..=spread).contains(&sd[k]);
    let is_hardly =
        |k: usize| calibration.parameters[k].spread.is_some_and(|spread| spread > 0.0 && within(k, spread));
    let names = names(calibration, is_hardly)?;
    Some(format!(
        "The data determine {names} hardly better than the datasheet: the standard deviation is more than half the datasheet spread. \
         Use a motion that excites it more, or record more data."
    ))
}

fn mostly_prior(calibration: &Calibration) -> Option<String> {
    let is_told = |k: usize| calibration.prior_share.get(k).is_some_and(|share| *share > MOSTLY_PRIOR);
    // of the datasheet, `hardly_determined` says it
    let names = names(calibration, is_told).filter(|_| !calibration.datasheet_prior)?;
    Some(format!("The data give less information than the prior about {names}."))
}

/// An accelerometer alone has a warning about this.
fn unchecked(calibration: &Calibration) -> Option<String> {
    (calibration.gyroscope.is_some() && calibration.fit.degrees_of_freedom == 0)
        .then(|| "The data are as many as the unknowns, so nothing checks the fit.".to_string())
}
