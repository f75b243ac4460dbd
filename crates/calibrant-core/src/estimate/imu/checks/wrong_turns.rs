//! Turns of known angle that the gyroscope contradicts: swapped, of another angle, or read in another unit.
//!
//! A turn adds up to `S φ e`, and the errors of a sensor are a few per cent of its angle and some degrees of its axis, twice where both sensors have them. How the sensor sits in the
//! frame of the directions the faces tell. A gyroscope whose axes are all
//! turned alike against the accelerometer's sits otherwise in its housing; no sensor is a mirror image of another.
//!
//! On known faces such turns are refused. Else the rotations between the holds say something of the gyroscope, too, and the user is warned.

use crate::diagnostic::gyroscope::AxesInOtherOrder;
use crate::diagnostic::turns::{TurnShare, TurnUnlikeGiven};
use crate::diagnostic::{AGREES_RAD, Diagnostic, TurnMismatch, UnitMistake};
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::alignment::axes::{axis_names, orders};
use crate::estimate::imu::checks::evidence::Diagnostics;
use crate::estimate::imu::model::TurnData;
use crate::estimate::imu::problem::{Gyroscope, Turn};
use crate::sensor::{ImuParameters, ReadingUnit, SensorKind};
use nalgebra::{Matrix3, Vector3};

/// All turns may show this share of their angle, where the range is not the one that was set. A warning says so.
const PLAUSIBLE_SHARES: std::ops::RangeInclusive<f64> = 0.55..=1.8;

/// Readings in SI show another turn where their angle is off by more than this share.
const OTHER_TURN_SHARE: f64 = 0.25;

/// A factor is taken for 180/π where it is as close as this share.
const NEAR_DEGREES: f64 = 0.1;

/// Refuses turns on known faces that the gyroscope contradicts, and warns of others; warns where its axes are the accelerometer's in another order. `imu`: the accelerometer, and the gyroscope's
/// bias.
pub(crate) fn check(
    gyroscope: &Gyroscope,
    imu: &ImuParameters,
    data: &[TurnData],
    turns: &[Turn],
    on_faces: bool,
) -> Result<Diagnostics> {
    let Some(shown) = ShownTurns::of(gyroscope, imu, data).filter(|_| !data.is_empty()) else {
        return Ok(Vec::new());
    };
    let share = shown.same_share().filter(|_| gyroscope.unit != ReadingUnit::Counts);
    let unlike = share.filter(|share| (share - 1.0).abs() > OTHER_TURN_SHARE);
    if let Some(share) = unlike {
        if !on_faces || PLAUSIBLE_SHARES.contains(&share) {
            return Ok(vec![Diagnostic::from(TurnShare { share, mistake: factor(share) })]);
        }
        let help = if share < 0.0 {
            "angles are right-handed about the axis: is the sign of the angle of the turns right (gyroscope.turn_angle_deg, angle_deg)? else change the sign of the gyroscope's columns"
        } else {
            "correct the unit of the gyroscope, the sample rate, or the angle of the turns (gyroscope.turn_angle_deg, angle_deg)"
        };
        let why = factor(share).map_or_else(String::new, |why| format!(": {why}"));
        let message = format!("the gyroscope shows {share:.3} of the angle of every turn{why}");
        return Err(Error::recording(InputError::new(Refusal::TurnsContradicted, message, help)));
    }
    let share = share.unwrap_or(1.0);
    let wrong = shown.wrong(&Matrix3::identity(), share);
    if wrong.is_empty() {
        return Ok(Vec::new());
    }
    let alike = |order: &&Matrix3<f64>| order.determinant() > 0.0 && shown.wrong(order, share).is_empty();
    let orders = orders();
    let mut alike = orders.iter().filter(alike);
    if let (Some(order), None) = (alike.next(), alike.next()) {
        // else the rotations show it
        let stated =
            on_faces.then(|| Diagnostic::from(AxesInOtherOrder { order: axis_names(order), by_turns: true }));
        return Ok(stated.into_iter().collect());
    }
    let mismatch = |&k: &usize| {
        let (turned, by) = (&shown.in_frame[k], &data[k].angle);
        let mistake = factor(turned.dot(by) / by.norm_squared());
        (shows_another(k, &turns[k], turned), mistake)
    };
    let mismatches = wrong.iter().map(mismatch);
    if !on_faces {
        let warning = |(turn, mistake)| Diagnostic::from(TurnUnlikeGiven { turn, mistake });
        return Ok(mismatches.map(warning).collect());
    }
    let exchanged = wrong.iter().all(|&k| wrong.iter().any(|&other| other != k && shown.is(k, other, share)));
    let help = if exchanged {
        "exchange these turns (x_rot, y_rot, z_rot in a list of sections, gyroscope.turns), or the gyroscope's columns"
    } else {
        "correct axis, angle or times of the turn (x_rot, y_rot, z_rot in a list of sections, gyroscope.turns); where an axis of the gyroscope reads with the opposite sign, change the \
         sign of its column"
    };
    let words = |(turn, mistake): (TurnMismatch, Option<UnitMistake>)| match mistake {
        Some(mistake) => format!("{turn}, {mistake}"),
        None => turn.to_string(),
    };
    Err(Error::experiment(InputError::new(
        Refusal::TurnsContradicted,
        mismatches.map(words).collect::<Vec<_>>().join("; "),
        help,
    )))
}

/// What a factor between the angle that the gyroscope shows and the one that was given tells, if it is that between degrees and radians.
fn factor(share: f64) -> Option<UnitMistake> {
    const DEGREES: f64 = 180.0 / std::f64::consts::PI;
    let near = |factor: f64| (share / factor - 1.0).abs() < NEAR_DEGREES;
    if near(DEGREES) {
        return Some(UnitMistake::DegreesAsRadians);
    }
    near(1.0 / DEGREES).then_some(UnitMistake::RadiansAsDegrees)
}

/// Is what readings in SI show of a turn another one, by its angle or by its axis? Errors of a few degrees and per cent in both sensors are none.
fn is_another(shown: &Vector3<f64>, given: &Vector3<f64>) -> bool {
    (shown.norm() / given.norm() - 1.0).abs() > OTHER_TURN_SHARE || shown.angle(given) > AGREES_RAD
}

/// What was given of a turn, and what is shown of it, rad.
fn shows_another(number: usize, turn: &Turn, shown: &Vector3<f64>) -> TurnMismatch {
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

/// What the gyroscope shows of each turn.
struct ShownTurns<'a> {
    data: &'a [TurnData],
    /// In the frame of the directions, rad.
    in_frame: Vec<Vector3<f64>>,
    /// From the frame of the directions to the accelerometer's axes.
    mounting: Matrix3<f64>,
}

impl<'a> ShownTurns<'a> {
    fn of(gyroscope: &Gyroscope, imu: &ImuParameters, data: &'a [TurnData]) -> Option<Self> {
        let svd = imu[SensorKind::Accelerometer].matrix.svd(true, true);
        let mounting = svd.u? * svd.v_t?;
        let readings: Vec<Vector3<f64>> = data.iter().map(|turn| turn.beyond_bias(imu)).collect();
        let mut gains: Vec<f64> =
            readings.iter().zip(data).map(|(shown, turn)| shown.norm() / turn.angle.norm()).collect();
        gains.sort_by(f64::total_cmp);
        // most turns tell a gain that is not known
        let gain = match (gyroscope.unit, gyroscope.gain) {
            (ReadingUnit::Counts, Some(gain)) => gain,
            (ReadingUnit::Counts, None) => Vector3::repeat(*gains.get(gains.len() / 2)?),
            _ => Vector3::repeat(1.0),
        };
        let in_frame =
            readings.iter().map(|shown| mounting.transpose() * shown.component_div(&gain)).collect();
        Some(Self { data, in_frame, mounting })
    }

    /// Is what a turn shows this rotation?
    fn agrees(&self, k: usize, rotation: &Vector3<f64>) -> bool {
        !is_another(&self.in_frame[k], rotation)
    }

    /// Does a turn show another one?
    fn is(&self, k: usize, other: usize, share: f64) -> bool {
        self.agrees(k, &(self.data[other].angle * share))
    }

    /// Turns that show something else, with the gyroscope's axes in such an order.
    fn wrong(&self, order: &Matrix3<f64>, share: f64) -> Vec<usize> {
        let turned = self.mounting.transpose() * order * self.mounting;
        (0..self.data.len()).filter(|&k| !self.agrees(k, &(turned * self.data[k].angle * share))).collect()
    }

    /// The share of their angle that all turns show, where it is the same.
    fn same_share(&self) -> Option<f64> {
        let pairs = || self.in_frame.iter().zip(self.data);
        let of =
            |(shown, turn): (&Vector3<f64>, &TurnData)| shown.dot(&turn.angle) / turn.angle.norm_squared();
        let share = pairs().map(of).sum::<f64>() / self.data.len() as f64;
        let follows = |(shown, turn): (&Vector3<f64>, &TurnData)| !is_another(shown, &(turn.angle * share));
        pairs().all(follows).then_some(share)
    }
}
