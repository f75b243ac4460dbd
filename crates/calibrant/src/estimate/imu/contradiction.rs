//! What was given beforehand (turns, priors, noise, units), where the data contradict it.

use super::joint::{Fit, Joint, TurnData};
use super::mistaken::{AGREES_RAD, turned_frame, words};
use super::{ImuCalibration, NoiseSource, Turn};
use crate::sensor::{Axis, ReadingUnit, Triad};
use nalgebra::Vector3;

/// Standard deviations by which the data may be off what was given before it is told.
const CONTRADICTED: f64 = 4.5;
/// Readings in SI whose angle is off that of a turn by more than this share show another one.
const OTHER_TURN: f64 = 0.25;
/// A factor this close to 180/π is taken for it.
const DEGREES_OR_RADIANS: f64 = 0.1;
/// Gains of readings in SI that are plausible.
const GAINS: std::ops::RangeInclusive<f64> = 0.8..=1.25;
/// Scatter within holds over the noise that was given that is not worth a word.
const NOISE: std::ops::RangeInclusive<f64> = 0.5..=2.0;

/// Warnings. `scatter`: of the gyroscope's samples within holds; `reordered`: was it said already that its axes are others?
pub(super) fn contradictions(
    calibration: &ImuCalibration,
    (joint, fit): (&Joint<'_>, &Fit),
    turns: &[Turn],
    scatter: &Vector3<f64>,
    reordered: bool,
) -> Vec<String> {
    let mut warnings = of_turns(joint, fit, turns, calibration);
    if let Some((mean, weight)) = &joint.prior {
        for (k, quantity) in joint.quantities.iter().enumerate() {
            let off = (quantity.of(&fit.state.imu) - mean[k]).abs() * weight[k].sqrt();
            if off > CONTRADICTED {
                warnings.push(format!(
                    "the data contradict what [known] says of {}: {off:.0} standard deviations from {}",
                    quantity.name(),
                    mean[k]
                ));
            }
        }
    }
    let degrees = calibration.degrees_of_freedom as f64;
    if degrees > 0.0 && fit.chi2 > degrees + 6.0 * (2.0 * degrees).sqrt() {
        warnings.push(format!(
            "χ² is {:.0} with {degrees:.0} degrees of freedom: the data contradict what was given (fixed terms and priors in [known], directions, turns, noise), and \
             the standard deviations are too small",
            fit.chi2
        ));
    }
    let (after, before) = (calibration.rotation_rms_rad(), calibration.rotation_rms_before_rad());
    if after > before {
        warnings.push(format!(
            "gravity after a rotation is missed by more than before the calibration, {:.2}° in place of {:.2}°: something that was given does not fit the rotations",
            after.to_degrees(),
            before.to_degrees()
        ));
    }
    warnings.extend(of_gains(calibration, reordered));
    if calibration.still.noise_source == NoiseSource::Datasheet {
        for axis in Axis::ALL {
            let ratio = scatter[axis.index()] / joint.gyroscope_noise.of_sample[axis.index()];
            if !NOISE.contains(&ratio) {
                warnings.push(format!(
                    "the scatter of the gyroscope's axis {axis} within the holds is {ratio:.2} times the noise that was given"
                ));
            }
        }
    }
    warnings
}

fn of_turns(joint: &Joint<'_>, fit: &Fit, turns: &[Turn], calibration: &ImuCalibration) -> Vec<String> {
    let mut warnings = Vec::new();
    let on_faces = calibration.frame_is_known();
    if calibration.gyroscope_unit != ReadingUnit::Counts {
        if let Some(share) = same_share(joint, fit) {
            let why = factor(share)
                .unwrap_or("are the angle of the turns, the sample rate and the gyroscope's unit right?");
            return vec![format!("the gyroscope shows {share:.3} of the angle of every turn: {why}")];
        }
        // on known faces these were refused before
        let other = joint.turns.iter().zip(turns).enumerate().filter(|_| !on_faces);
        warnings.extend(other.filter_map(|(k, (data, turn))| other_turn(fit, data, turn, k)));
    }
    if !warnings.is_empty() {
        // the others fit badly since these do
        return warnings;
    }
    for (number, (data, turn)) in joint.turns.iter().zip(turns).enumerate() {
        let residual = joint.turn_residual(data, &fit.state.imu);
        let off = residual.component_mul(&residual).dot(&data.weight).sqrt();
        if off > CONTRADICTED {
            warnings.push(format!(
                "{}, {:.1}°, does not fit the other data, by {off:.0} standard deviations: are its times, axis and angle right?",
                turn.named(number),
                turn.angle_rad.to_degrees()
            ));
        }
    }
    warnings
}

/// The share of their angle that several turns show, where it is the same of all and far from one: no turn is wrong then, but what they have in common.
fn same_share(joint: &Joint<'_>, fit: &Fit) -> Option<f64> {
    let shown = |data: &TurnData| data.beyond_bias(&fit.state.imu);
    let share = |data: &TurnData| shown(data).dot(&data.angle) / data.angle.norm_squared();
    let mean = joint.turns.iter().map(share).sum::<f64>() / joint.turns.len() as f64;
    let follows =
        |data: &TurnData| (shown(data) - mean * data.angle).norm() < 0.1 * mean.abs() * data.angle.norm();
    (joint.turns.len() > 1 && (mean - 1.0).abs() > OTHER_TURN && joint.turns.iter().all(follows))
        .then_some(mean)
}

/// What a factor between the angle that the gyroscope shows and the one that was given tells, if it is that between degrees and radians.
pub(super) fn factor(share: f64) -> Option<&'static str> {
    const DEGREES: f64 = 180.0 / std::f64::consts::PI;
    let near = |factor: f64| (share / factor - 1.0).abs() < DEGREES_OR_RADIANS;
    if near(DEGREES) {
        return Some(
            "180/π times. Is the angle in radians, where degrees are meant (angle_deg = 360.0 for a whole turn), or are the gyroscope's readings in deg/s and read as rad/s?",
        );
    }
    near(1.0 / DEGREES).then_some("π/180 of it. Are the gyroscope's readings in rad/s and read as deg/s?")
}

/// Is what readings in SI show of a turn another one, by its angle or by its axis? Errors of a few degrees and per cent in both sensors are none.
pub(super) fn is_another(shown: &Vector3<f64>, given: &Vector3<f64>) -> bool {
    (shown.norm() / given.norm() - 1.0).abs() > OTHER_TURN || shown.angle(given) > AGREES_RAD
}

/// A turn of which the readings, in SI, show quite another one.
fn other_turn(fit: &Fit, data: &TurnData, turn: &Turn, number: usize) -> Option<String> {
    let shown = data.beyond_bias(&fit.state.imu);
    let share = shown.dot(&data.angle) / data.angle.norm_squared();
    let why = factor(share)
        .map_or_else(|| ": correct its angle, its axis or its times".to_owned(), |why| format!(", {why}"));
    is_another(&shown, &data.angle).then(|| format!("{}{why}", shows_another(number, turn, &shown)))
}

/// What was given of a turn, and what is shown of it, rad.
pub(super) fn shows_another(number: usize, turn: &Turn, shown: &Vector3<f64>) -> String {
    // about the axis as it was named
    let along = shown.dot(&turn.axis);
    let sign = if along.abs() > 0.5 * shown.norm() { along.signum() } else { turn.angle_rad.signum() };
    let about = (sign * shown).try_normalize(0.0).unwrap_or(turn.axis);
    format!(
        "{} is given as {:.1}° about {}, and the gyroscope shows {:.0}° about {}",
        turn.named(number),
        turn.angle_rad.to_degrees(),
        words(&turn.axis),
        (sign * shown.norm()).to_degrees(),
        words(&about)
    )
}

/// Readings in SI have gains near one, each axis along its own.
fn of_gains(calibration: &ImuCalibration, reordered: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    for (triad, unit) in [
        (Triad::Accelerometer, calibration.accelerometer_unit),
        (Triad::Gyroscope, calibration.gyroscope_unit),
    ] {
        if unit == ReadingUnit::Counts || (triad == Triad::Gyroscope && reordered) {
            continue;
        }
        let matrix = &calibration.imu.triad(triad).matrix;
        if calibration.frame_is_known() && turned_frame(matrix) {
            // the faces and turns say it better
            continue;
        }
        for axis in Axis::ALL {
            let along = matrix[(axis.index(), axis.index())];
            if !GAINS.contains(&along) {
                warnings.push(format!(
                    "the {triad} shows {along:.3} of what there is along its axis {axis}, for readings in {} it should be near 1: are unit, sample rate, order and \
                     direction of the axes right, and what was given of turns and faces?",
                    unit.symbol()
                ));
            }
        }
    }
    warnings
}
