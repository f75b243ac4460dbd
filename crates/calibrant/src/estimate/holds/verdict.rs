//! What a user should know about a static calibration, in words.

use super::{Calibration, HoldResult, Recovered};
use crate::error::UndeterminedGroup;
use crate::estimate::CalibrationStatus;
use crate::estimate::statistics::implausible;
use crate::motion::Hold;
use crate::sensor::{Axis, ParameterList};
use nalgebra::Vector3;

/// A condition number above which the holds do not spread enough. Twenty-four even orientations give about 3, six faces with their edges about 10.
const CONDITION: f64 = 100.0;

/// Says why the holds do not determine these parameters.
pub(super) fn explain(
    holds: &[Hold],
    list: &ParameterList,
    parameters: &[usize],
    free_combinations: usize,
) -> UndeterminedGroup {
    let names = list.names();
    let every = parameters.is_empty();
    let reason = match holds.len() {
        0 => "no hold was found in the recording: the sensor was never still for long enough".to_owned(),
        1 => "only one hold was found".to_owned(),
        count if count < list.len() => format!(
            "{count} holds give {count} equations (the magnitude of gravity in each) for {} parameters",
            list.len()
        ),
        count => format!(
            "the {count} holds do not spread enough: they lie in too few different orientations, or on one circle"
        ),
    };
    UndeterminedGroup {
        parameters: if every { names } else { parameters.iter().map(|&k| names[k].clone()).collect() },
        free_combinations: if every { list.len().saturating_sub(holds.len()) } else { free_combinations },
        reason,
        remedy: format!(
            "hold the sensor still in at least {} well-spread orientations: each axis up, down and at angles in between",
            list.len() + 3
        ),
    }
}

/// Warnings about a fit.
pub(super) fn warnings(calibration: &Calibration, weakest: &[String]) -> Vec<String> {
    let mut warnings = Vec::new();
    let Recovered::Holds(holds) = &calibration.recovered else { return warnings };
    if calibration.status != CalibrationStatus::Converged {
        warnings.push(format!(
            "the iteration did not converge ({}): the numbers are the best found, not the optimum",
            calibration.status.name()
        ));
    }
    let bad: Vec<String> = holds
        .holds
        .iter()
        .enumerate()
        .filter(|(_, hold)| !hold.used)
        .map(|(k, hold)| {
            format!(
                "hold {} ({:.1} to {:.1} s) was left out: its magnitude is off by {:.2} mm/s², {:.1} standard deviations",
                k + 1,
                hold.hold.start_s,
                hold.hold.end_s,
                1e3 * hold.magnitude_residual_mps2,
                hold.studentised_residual.abs()
            )
        })
        .collect();
    warnings.extend(bad);
    let used: Vec<&HoldResult> = holds.holds.iter().filter(|hold| hold.used).collect();
    if calibration.fit.degrees_of_freedom == 0 {
        warnings.push(format!(
            "{} holds for {} parameters leave nothing to check the fit with: the standard deviations rest on the noise within the holds \
             alone and are too small; add holds",
            used.len(),
            calibration.parameters.len()
        ));
    } else if calibration.fit.degrees_of_freedom < 5 {
        warnings.push(format!(
            "only {} more holds than parameters: the standard deviations themselves are known to about {:.0} %",
            calibration.fit.degrees_of_freedom,
            100.0 / (2.0 * calibration.fit.degrees_of_freedom as f64).sqrt()
        ));
    }
    if holds.condition_number > CONDITION {
        warnings.push(format!(
            "the holds do not spread enough (condition number {:.0}): {} can hardly be told apart",
            holds.condition_number,
            weakest.join(", ")
        ));
    }
    let missing = missing_faces(&used);
    if !missing.is_empty() && (holds.condition_number > CONDITION / 3.0 || missing.len() > 1) {
        warnings.push(format!("no hold has {}: add one there", missing.join(" or ")));
    }
    if let (Some(assumed), Some(found)) = (calibration.fit.assumed_noise, calibration.fit.noise_estimate) {
        for axis in Axis::ALL {
            let ratio = found[axis.index()] / assumed[axis.index()];
            if !(0.5..=2.0).contains(&ratio) {
                warnings.push(format!(
                    "the noise of axis {axis} within the holds is {ratio:.2} times the one in the experiment file (not used: the \
                     recording's own is)"
                ));
            }
        }
    }
    warnings.extend(implausible(calibration));
    warnings
}

/// Directions, out of ±x, ±y, ±z, near which there is no hold.
fn missing_faces(holds: &[&HoldResult]) -> Vec<String> {
    let mut missing = Vec::new();
    for axis in Axis::ALL {
        for (sign, word) in [(1.0, "up"), (-1.0, "down")] {
            let mut face = Vector3::zeros();
            face[axis.index()] = sign;
            let nearest =
                holds.iter().map(|hold| hold.force_mps2.normalize().dot(&face)).fold(-1.0, f64::max);
            if nearest < 0.5 {
                missing.push(format!("the {axis} axis pointing {word}"));
            }
        }
    }
    missing
}
