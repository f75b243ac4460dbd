//! The verdict on a calibration on a machine: can it be used?

use crate::calibration::noise_explains;
use crate::words::message;
use crate::{About, html, number_format};
use calibrant_core::estimate::CalibrationStatus;
use calibrant_core::sensor::Invariant;
use calibrant_machine::estimate::{MachineCalibration, MachineTrust};

/// Below this share of samples used, the reader should know.
const HARDLY_USED: f64 = 0.9;
/// Below this probability, the noise does not explain the data.
const UNEXPLAINED: f64 = 0.001;
/// From this widening on, the reader should know of correlated residuals.
const CORRELATED: f64 = 1.5;

/// The verdict with its warnings, as one prominent box.
pub(super) fn verdict(calibration: &MachineCalibration, about: &About) -> String {
    let warnings = calibration.warnings.iter().map(message);
    let remarks: Vec<String> = warnings
        .chain(unexplained(calibration))
        .chain(hardly_used(calibration))
        .chain(correlated(calibration))
        .collect();
    let (class, word) = match (calibration.status, remarks.is_empty()) {
        (CalibrationStatus::Converged, true) => ("good", "✓ Usable."),
        (CalibrationStatus::Converged, false) => ("caution", "! Usable; read the warnings first."),
        _ => ("bad", "✗ Do not use: the estimation did not converge."),
    };
    let lists = [("Warnings", remarks), ("About the recording", about.findings.clone())];
    html::verdict_box(class, word, &sentence(calibration), &lists)
}

fn sentence(calibration: &MachineCalibration) -> String {
    let sensors: Vec<String> = calibration.noise.iter().map(|of| of.sensor.to_string()).collect();
    let samples = calibration.noise.iter().map(|of| of.residuals.len()).max().unwrap_or(0);
    let reference = match calibration.joints.len() {
        0 => "the logged poses of the body".to_string(),
        count => format!("the logged positions of {}", number_format::counted(count, "joint")),
    };
    let trust = match calibration.trust {
        MachineTrust::Known => "which were trusted as exact",
        MachineTrust::Noisy => "whose noise was estimated too",
    };
    format!(
        "{} against {reference}, {trust}. {} samples were used, {} of all. {}",
        capitalised(&sensors.join(" and ")),
        number_format::count(samples),
        number_format::percent(calibration.used_share),
        gains(calibration)
    )
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().to_string() + letters.as_str())
}

/// The relative standard deviation of each sensor's gains, on the worst axis.
fn gains(calibration: &MachineCalibration) -> String {
    let invariants = calibration.calibrated().invariants();
    let of_sensor = |sensor| {
        let relative = invariants
            .iter()
            .filter(|found| matches!(found.invariant, Invariant::Gain(of, _) if of == sensor))
            .filter_map(|found| Some(found.sd? / found.value));
        let worst = relative.fold(0.0, f64::max);
        (worst > 0.0).then(|| format!("{} ({sensor})", number_format::percent(worst)))
    };
    let known: Vec<String> = calibration.noise.iter().filter_map(|of| of_sensor(of.sensor)).collect();
    if known.is_empty() {
        return String::new();
    }
    format!("The gains are known to {}, one standard deviation on the worst axis.", known.join(" and "))
}

fn unexplained(calibration: &MachineCalibration) -> Option<String> {
    calibration.fit.p_value.filter(|p| *p < UNEXPLAINED).map(|p| noise_explains(p) + ".")
}

fn hardly_used(calibration: &MachineCalibration) -> Option<String> {
    (calibration.used_share < HARDLY_USED).then(|| {
        format!(
            "Only {} of the sensor’s samples lie within the reference’s log and outside of its gaps.",
            number_format::percent(calibration.used_share)
        )
    })
}

fn correlated(calibration: &MachineCalibration) -> Option<String> {
    let largest = calibration.inflation.iter().copied().fold(1.0, f64::max);
    (largest > CORRELATED).then(|| {
        format!(
            "The residuals are correlated in time. The stated standard deviations allow for it: they are up to {} times those of independent residuals.",
            number_format::significant(largest, 2)
        )
    })
}
