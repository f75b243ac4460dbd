//! The verdict on an IMU's calibration: can it be used?

use super::quality::imu_quality;
use crate::words::message;
use crate::{About, html, number_format};
use calibrant_core::estimate::{CalibrationStatus, ImuCalibration};
use calibrant_core::sensor::{Invariant, SensorKind};

/// Above this share of the prior in its information, a parameter is more prior knowledge than data.
const MOSTLY_PRIOR: f64 = 0.5;
/// The calibration must lower the rotation errors to this factor or less; otherwise it has not explained
/// them.
const IMPROVED: f64 = 0.8;

/// The verdict and everything that qualifies it, as one prominent box.
pub(super) fn verdict(calibration: &ImuCalibration, about: &About) -> String {
    let mut remarks = calibration.warnings.iter().map(message).collect::<Vec<_>>();
    remarks.extend(not_improved(calibration));
    remarks.extend(mostly_prior(calibration));
    if calibration.degrees_of_freedom == 0 {
        remarks.push("There are no more data than unknowns, so nothing checks the fit.".to_string());
    }
    let (class, word) = match calibration.status {
        CalibrationStatus::Converged if remarks.is_empty() => ("good", "✓ Usable."),
        CalibrationStatus::Converged => ("caution", "! Usable; read the warnings first."),
        _ => ("bad", "✗ Do not use: the estimation did not converge."),
    };
    let lists = [("Warnings", remarks), ("About the recording", about.findings.clone())];
    html::verdict_box(class, word, &sentence(calibration), &lists)
}

fn sentence(calibration: &ImuCalibration) -> String {
    let (holds, rotations) = (&calibration.holds.holds, &calibration.rotations);
    let mut from = vec![format!(
        "{} of {}",
        holds.iter().filter(|hold| hold.used).count(),
        number_format::counted(holds.len(), "hold")
    )];
    if !rotations.is_empty() {
        from.push(format!(
            "{} of {} between them",
            rotations.iter().filter(|rotation| rotation.used).count(),
            number_format::counted(rotations.len(), "rotation")
        ));
    }
    if !calibration.turns.is_empty() {
        from.push(number_format::counted(calibration.turns.len(), "turn") + " of known angle");
    }
    let last = from.pop().unwrap_or_default();
    let from = if from.is_empty() { last } else { format!("{} and {last}", from.join(", ")) };
    let quality = imu_quality(calibration);
    let mut letters = quality.chars();
    let quality =
        letters.next().map_or_else(String::new, |first| first.to_uppercase().to_string() + letters.as_str());
    format!(
        "Accelerometer and gyroscope were calibrated together, from {from}. {quality}. {}.",
        gains(calibration)
    )
}

/// How well the gains of each sensor are known, on the worst axis.
fn gains(calibration: &ImuCalibration) -> String {
    let invariants = calibration.calibrated().invariants();
    let known: Vec<String> = SensorKind::ALL
        .iter()
        .map(|&sensor_kind| {
            let worst = invariants
                .iter()
                .filter(|found| matches!(found.invariant, Invariant::Gain(of, _) if of == sensor_kind))
                .map(|found| found.sd.unwrap_or(0.0) / found.value)
                .fold(0.0, f64::max);
            format!("{} ({sensor_kind})", number_format::percent(worst))
        })
        .collect();
    format!("The gains are known to {}, one standard deviation on the worst axis", known.join(" and "))
}

fn not_improved(calibration: &ImuCalibration) -> Option<String> {
    let (after, before) = (calibration.rotation_rms_rad(), calibration.rotation_rms_before_rad());
    (after > IMPROVED * before).then(|| {
        "The calibration hardly improves the rotations: either the gyroscope was good before, or something else than its gains and misalignment \
         makes them miss gravity (saturation, delay between the sensors, a sample rate that is too low for the turns)."
            .to_string()
    })
}

fn mostly_prior(calibration: &ImuCalibration) -> Option<String> {
    let names: Vec<String> = calibration
        .quantities
        .iter()
        .zip(&calibration.prior_share)
        .filter(|(_, share)| **share > MOSTLY_PRIOR)
        .map(|(quantity, _)| quantity.name())
        .collect();
    (!names.is_empty())
        .then(|| format!("The data say less than what was known beforehand about {}.", names.join(", ")))
}
