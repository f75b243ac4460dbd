//! A turn of known angle of which the gyroscope shows another one.

use crate::diagnostic::{AGREES_RAD, TurnMismatch, UnitMistake};
use crate::estimate::imu::problem::Turn;
use nalgebra::Vector3;

/// Readings in SI show another turn where their angle is off by more than this share.
pub(crate) const OTHER_TURN_SHARE: f64 = 0.25;

/// A factor is taken for 180/π where it is as close as this share.
const NEAR_DEGREES: f64 = 0.1;

/// What a factor between the angle that the gyroscope shows and the one that was given tells, if it is that between degrees and radians.
pub(crate) fn factor(share: f64) -> Option<UnitMistake> {
    const DEGREES: f64 = 180.0 / std::f64::consts::PI;
    let near = |factor: f64| (share / factor - 1.0).abs() < NEAR_DEGREES;
    if near(DEGREES) {
        return Some(UnitMistake::DegreesAsRadians);
    }
    near(1.0 / DEGREES).then_some(UnitMistake::RadiansAsDegrees)
}

/// Is what readings in SI show of a turn another one, by its angle or by its axis? Errors of a few degrees and per cent in both sensors are none.
pub(crate) fn is_another(shown: &Vector3<f64>, given: &Vector3<f64>) -> bool {
    (shown.norm() / given.norm() - 1.0).abs() > OTHER_TURN_SHARE || shown.angle(given) > AGREES_RAD
}

/// What was given of a turn, and what is shown of it, rad.
pub(crate) fn shows_another(number: usize, turn: &Turn, shown: &Vector3<f64>) -> TurnMismatch {
    // about the axis as it was named
    let along = shown.dot(&turn.axis);
    let sign = if along.abs() > 0.5 * shown.norm() { along.signum() } else { turn.angle_rad.signum() };
    let about = (sign * shown).try_normalize(0.0).unwrap_or(turn.axis);
    TurnMismatch {
        turn: turn.span(number),
        given_rad: turn.angle_rad,
        given_about: turn.axis,
        shown_rad: sign * shown.norm(),
        shown_about: about,
    }
}
