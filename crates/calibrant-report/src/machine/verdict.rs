//! The verdict on a calibration on a machine: can it be used?

use super::validation::validation_in_short;
use crate::About;
use crate::calibration::{calibration_verdict, noise_explains, worst_gain};
use crate::number_format::{self, capitalised, counted, percent};
use crate::sheet::SheetVerdict;
use calibrant_machine::estimate::{MachineCalibration, MachineTrust, MachineValidation};

/// Below this probability, the noise does not explain the data.
const UNEXPLAINED: f64 = 0.001;

pub(super) fn verdict(
    calibration: &MachineCalibration,
    validations: &[MachineValidation],
    about: &About,
) -> SheetVerdict {
    let validation = validation_in_short(validations);
    calibration_verdict(
        &calibration.sensors.warnings,
        unexplained(calibration),
        validation,
        &sentence(calibration),
        about,
    )
}

fn sentence(calibration: &MachineCalibration) -> String {
    let sensors: Vec<String> = calibration.noise.iter().map(|of| of.sensor.to_string()).collect();
    let samples = calibration.noise.iter().map(|of| of.residuals.len()).max().unwrap_or(0);
    let reference = match calibration.joints.len() {
        0 => "the logged poses of the body".to_string(),
        count => format!("the logged positions of {}", counted(count, "joint")),
    };
    let trust = match calibration.trust {
        MachineTrust::Known => "which were trusted as exact",
        MachineTrust::Noisy => "whose noise was estimated too",
    };
    format!(
        "{} against {reference}, {trust}. {} samples were used, {} of all. {}",
        capitalised(&sensors.join(" and ")),
        number_format::count(samples),
        percent(calibration.used_share),
        gains(calibration)
    )
}

/// The relative standard deviation of each sensor's gains, on the worst axis.
fn gains(calibration: &MachineCalibration) -> String {
    let invariants = calibration.sensors.calibrated().invariants();
    let of_sensor = |sensor| {
        let worst = worst_gain(&invariants, sensor);
        (worst > 0.0).then(|| format!("{} ({sensor})", percent(worst)))
    };
    let known: Vec<String> = calibration.noise.iter().filter_map(|of| of_sensor(of.sensor)).collect();
    if known.is_empty() {
        return String::new();
    }
    format!("The gains are known to {}, one standard deviation on the worst axis.", known.join(" and "))
}

fn unexplained(calibration: &MachineCalibration) -> Option<String> {
    calibration.sensors.fit.p_value.filter(|p| *p < UNEXPLAINED).map(|p| noise_explains(p) + ".")
}
