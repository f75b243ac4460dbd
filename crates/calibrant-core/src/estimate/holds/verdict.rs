//! Warnings about a static calibration, and the reason if it is not determined.

use super::bent_response::bent_response;
use crate::diagnostic::fit::{FewDegreesOfFreedom, ModelContradicted, NotConverged, NothingToCheck};
use crate::diagnostic::holds::{
    GravityUnusual, HoldLeftOut, HoldsLeftOutInARow, HoldsScatter, HoldsSpreadLittle, OrientationMissing,
};
use crate::diagnostic::{Diagnostic, FacePointing, HoldSpan};
use crate::error::{HARDLY_A_HOLD, UndeterminedGroup};
use crate::estimate::gravity_off_earth::gravity_off_earth;
use crate::estimate::{Calibration, CalibrationStatus, HoldCalibration, HoldResult, Recovered};

use crate::estimate::change::longest_run;
use crate::estimate::datasheet::noise_not_as_given;
use crate::motion::Hold;
use crate::sensor::{Axis, ParameterList, SensorKind};
use nalgebra::{Matrix3, Vector3};

/// Condition number of the information above which the directions of the holds are too similar. Twenty-four evenly spread orientations give about 3, six faces and orientations on the edges between them about 10.
const CONDITION: f64 = 100.0;
/// A scatter of the holds beyond their noise that no sensor at rest has, m/s².
const SCATTERED_MPS2: f64 = 0.02;
/// A scatter beyond this multiple of it refuses the model.
const CONTRADICTED: f64 = 10.0;
/// Fewer degrees of freedom hardly check a fit.
const FEWEST_FREE: usize = 5;
/// A correlation above which two parameters are hardly separated.
const CORRELATED: f64 = 0.9;
/// Holds lie in a plane or on a point if they extend by less than this share in one direction.
const FLAT: f64 = 0.02;
/// The means of holds in all directions lie on a sphere of this roundness, the least extent over the largest. Its centre is far from zero at this multiple of the largest extent.
const ROUND: f64 = 0.3;
const FAR_FROM_ZERO: f64 = 4.0;
/// Cosine of the angle up to which a direction is that of an axis: 15°.
const ALONG: f64 = 0.966;

/// The reason why the holds do not determine these parameters.
pub(super) fn explain(
    holds: &[Hold],
    list: &ParameterList,
    parameters: &[usize],
    free_combinations: usize,
) -> UndeterminedGroup {
    let names = list.names_in_results();
    let every = parameters.is_empty();
    let reason = match holds.len() {
        few @ (0 | 1) => HARDLY_A_HOLD[few].to_owned(),
        count if count < list.len() => format!(
            "{count} holds give {count} equations (the magnitude of gravity in each) for {} parameters",
            list.len()
        ),
        count => format!("the {count} holds do not spread enough: {}", arrangement(holds)),
    };
    let cross_terms = parameters.iter().any(|&k| names[k].contains(".matrix."));
    UndeterminedGroup {
        parameters: if every { names } else { parameters.iter().map(|&k| names[k].clone()).collect() },
        free_combinations: if every {
            list.len().saturating_sub(holds.len()).max(1)
        } else {
            free_combinations
        },
        reason,
        remedy: format!(
            "hold the sensor still, longer than holds.minimum_hold_s, in at least {} well-spread orientations: each axis up, down and at angles in \
             between{}",
            list.len() + FEWEST_FREE,
            match (holds.len(), cross_terms) {
                (1, _) =>
                    "; one pose gives the bias where its direction is known and the gains are stated: holds.intervals_s with holds.directions, and prior = \"datasheet\" in [calibrate]",
                (_, true) =>
                    "; the six faces alone do not determine cross-axis terms, for them use model = \"scale-bias\"",
                (_, false) => "",
            }
        ),
    }
}

/// The arrangement of holds whose directions are too similar, in words.
fn arrangement(holds: &[Hold]) -> String {
    let center = holds.iter().map(|hold| hold.mean).sum::<Vector3<f64>>() / holds.len() as f64;
    let scatter: Matrix3<f64> =
        holds.iter().map(|hold| (hold.mean - center) * (hold.mean - center).transpose()).sum();
    let eigen = (scatter / holds.len() as f64).symmetric_eigen();
    let extent = |k: usize| eigen.eigenvalues[k].max(0.0).sqrt();
    let (thin, long) = (eigen.eigenvalues.imin(), eigen.eigenvalues.imax());
    if extent(long) < FLAT * center.norm() {
        return "all are in the same orientation (a turn about the vertical does not change what an accelerometer shows)".into();
    }
    if center.norm() > FAR_FROM_ZERO * extent(long) && extent(thin) > ROUND * extent(long) {
        return "their means lie on a sphere far from zero, as with a bias of many g, another unit or a wrong column".into();
    }
    let normal = eigen.eigenvectors.column(thin);
    if extent(thin) < FLAT * extent(long) {
        return match Axis::ALL.into_iter().find(|axis| normal[axis.index()].abs() > ALONG) {
            Some(axis) => format!("all lie on one circle, turned about the sensor's axis {axis} only"),
            None => "all lie on one circle, turned about one axis of the sensor only".into(),
        };
    }
    "they lie in too few different orientations, or all along the sensor's axes".into()
}

/// Warnings about a fit.
pub(super) fn warnings(calibration: &Calibration, weakest: &[String]) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    let Recovered::Holds(holds) = &calibration.recovered else { return warnings };
    if calibration.status != CalibrationStatus::Converged {
        warnings.push(NotConverged { status: calibration.status.name() }.into());
    }
    warnings.extend(gravity_off_earth(&holds.gravity));
    let drift = holds.drift.as_ref();
    warnings
        .extend(drift.and_then(|drift| drift.beyond_expected(calibration.unit(SensorKind::Accelerometer))));
    warnings.extend(left_out(holds));
    let used: Vec<&HoldResult> = holds.used().collect();
    if calibration.fit.degrees_of_freedom == 0 {
        warnings.push(
            NothingToCheck { holds: Some(used.len()), parameters: calibration.parameters.len() }.into(),
        );
    } else if calibration.fit.degrees_of_freedom < FEWEST_FREE {
        let degrees_of_freedom = calibration.fit.degrees_of_freedom;
        warnings.push(FewDegreesOfFreedom { degrees_of_freedom }.into());
    }
    if holds.condition_number > CONDITION && are_correlated(calibration, weakest) {
        let (condition_number, parameters) = (holds.condition_number, weakest.to_vec());
        warnings.push(HoldsSpreadLittle { condition_number, parameters }.into());
    }
    let missing = missing_faces(&used);
    if !missing.is_empty() && (holds.condition_number > CONDITION / 3.0 || missing.len() > 1) {
        warnings.push(OrientationMissing { missing }.into());
    }
    if let (Some(assumed), Some(found)) = (calibration.fit.assumed_noise, calibration.fit.noise_estimate) {
        warnings.extend(noise_not_as_given(SensorKind::Accelerometer, &found, &assumed));
    }
    let between_holds_sd_mps2 = holds.between_holds_sd_mps2;
    if between_holds_sd_mps2 > SCATTERED_MPS2 {
        warnings.push(HoldsScatter { between_holds_sd_mps2 }.into());
    }
    warnings.extend(bent_response(calibration, &used));
    let ratio = between_holds_sd_mps2 / SCATTERED_MPS2;
    if ratio > CONTRADICTED {
        warnings.push(ModelContradicted { sensor_kind: SensorKind::Accelerometer, ratio }.into());
    }
    if !(9.7..=9.9).contains(&holds.gravity.magnitude_mps2) {
        warnings.push(GravityUnusual { gravity_mps2: holds.gravity.magnitude_mps2 }.into());
    }
    warnings.extend(calibration.beyond_datasheet());
    warnings
}

/// Are two of these parameters correlated so strongly that the data hardly separate them?
pub(in crate::estimate) fn are_correlated(calibration: &Calibration, parameters: &[String]) -> bool {
    let correlation = calibration.correlation();
    let named = |k: &usize| parameters.contains(&calibration.quantities[*k].name());
    let places: Vec<usize> = (0..calibration.quantities.len()).filter(named).collect();
    let largest = places.iter().flat_map(|&i| places.iter().filter(move |&&j| j < i).map(move |&j| (i, j)));
    largest.map(|(i, j)| correlation[(i, j)].abs()).fold(0.0, f64::max) > CORRELATED
}

/// The unused holds and why, and those in a row.
pub(in crate::estimate) fn left_out(holds: &HoldCalibration) -> Vec<Diagnostic> {
    holds
        .holds
        .iter()
        .enumerate()
        .filter_map(|(k, hold)| {
            let why = hold.why_left_out()?;
            Some(Diagnostic::from(HoldLeftOut { hold: HoldSpan::of(k, &hold.hold), why }))
        })
        .chain(left_out_in_a_row(holds))
        .collect()
}

/// Consecutive unused holds, if no change explains them.
fn left_out_in_a_row(holds: &HoldCalibration) -> Option<Diagnostic> {
    let sound: Vec<&HoldResult> = holds.holds.iter().filter(|hold| hold.reason.is_none()).collect();
    let run = longest_run(sound.iter().map(|hold| !hold.used)).filter(|_| holds.change.is_none())?;
    let (first, last) = (&sound[run.start].hold, &sound[run.end - 1].hold);
    Some(Diagnostic::from(HoldsLeftOutInARow { holds: run.len(), start_s: first.start_s, end_s: last.end_s }))
}

/// Directions, out of ±x, ±y, ±z, near which there is no hold.
fn missing_faces(holds: &[&HoldResult]) -> Vec<FacePointing> {
    let mut missing = Vec::new();
    for axis in Axis::ALL {
        for (sign, is_up) in [(1.0, true), (-1.0, false)] {
            let mut face = Vector3::zeros();
            face[axis.index()] = sign;
            let nearest =
                holds.iter().map(|hold| hold.force_mps2.normalize().dot(&face)).fold(-1.0, f64::max);
            if nearest < 0.5 {
                missing.push(FacePointing { axis, is_up });
            }
        }
    }
    missing
}
