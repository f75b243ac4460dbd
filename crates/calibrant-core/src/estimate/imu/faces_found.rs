//! Which of the known directions each hold is in, where nobody gave times: the one that its mean shows. The errors of a sensor are far smaller than
//! the angles between faces.

use crate::diagnostic::faces::FacesUnmatched;
use crate::diagnostic::{Diagnostic, FaceMismatch, HoldSpan, direction_in_words};
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::holds::median;
use crate::motion::{Gravity, Hold};
use crate::sensor::{Correction, Sensor};
use nalgebra::Vector3;

/// A hold is in a direction that it is at most this far from, rad: 20°. A box that is off level by 5° and crooked axes stay below it.
pub const ON_FACE_RAD: f64 = 0.35;

/// With fewer holds than this nothing is known of the bias, and a hold may be this far off, rad: 40°.
const FEWEST: usize = 4;
const AT_FIRST_RAD: f64 = 0.7;

/// Rounds that estimate the bias and the directions in turn.
const ROUNDS: usize = 4;

/// A direction whose norm is off unity by more than this is none: an axis was not up and down.
const LONGEST: f64 = 1.2;

/// Holds with their directions, in order of time, and what is to be said of the others.
#[derive(Debug, Clone)]
pub struct FacesFound {
    /// The holds.
    pub holds: Vec<Hold>,
    /// Their directions.
    pub directions: Vec<Vector3<f64>>,
    /// Holds in no direction, and directions without a hold.
    pub unmatched: Option<Diagnostic>,
}

/// Gives each hold of an accelerometer the direction, of these, that its mean shows.
///
/// # Errors
/// [`Error::Recording`]: no hold is in one of the directions, or the readings do not show which way is up. Without a gain each axis must have been up
/// and down.
pub fn faces_found(sensor: &Sensor, found: &[Hold], directions: &[Vector3<f64>]) -> Result<FacesFound> {
    let (mut holds, mut along, mut off) = (Vec::new(), Vec::new(), Vec::new());
    let farthest_rad = if found.len() < FEWEST { AT_FIRST_RAD } else { ON_FACE_RAD };
    for (number, (hold, up)) in found.iter().zip(shown(sensor, found, directions)?).enumerate() {
        let Some(near) = nearest(directions, &up) else { continue };
        if near.angle(&up) <= farthest_rad {
            holds.push(hold.clone());
            along.push(near);
        } else {
            off.push(FaceMismatch { hold: HoldSpan::of(number, hold), given: near, shown: up });
        }
    }
    if holds.is_empty() {
        let message = match off.first() {
            Some(first) => format!(
                "no hold is in one of holds.directions: the accelerometer shows {} up from {:.1} to {:.1} s",
                direction_in_words(&first.shown),
                first.hold.start_s,
                first.hold.end_s
            ),
            None => "no hold was found".to_owned(),
        };
        return refused(
            if off.is_empty() { Refusal::HoldsMissing } else { Refusal::FacesContradicted },
            message,
            "lay the sensor on its faces, and leave it on each for longer than holds.minimum_hold_s; directions are in the axes of the sensor",
        );
    }
    let missing = directions.iter().filter(|direction| !along.contains(direction));
    let missing: Vec<String> = missing.map(direction_in_words).collect();
    let unmatched =
        (!off.is_empty() || !missing.is_empty()).then(|| FacesUnmatched { holds: off, missing }.into());
    Ok(FacesFound { holds, directions: along, unmatched })
}

/// The direction, of these, that is nearest to another.
fn nearest(directions: &[Vector3<f64>], up: &Vector3<f64>) -> Option<Vector3<f64>> {
    directions.iter().copied().min_by(|one, other| one.angle(up).total_cmp(&other.angle(up)))
}

/// Which way is up in each hold, beside the bias. Where the datasheet states no gain, the largest and the smallest reading of each axis tell both.
fn shown(sensor: &Sensor, found: &[Hold], directions: &[Vector3<f64>]) -> Result<Vec<Vector3<f64>>> {
    let Some(correction) = sensor.nominal().as_ref().and_then(Correction::of) else { return by_ends(found) };
    let forces: Vec<Vector3<f64>> =
        found.iter().map(|hold| correction.apply(&hold.mean) / Gravity::SOMEWHERE.magnitude_mps2).collect();
    let mut bias = Vector3::zeros();
    let ups = |bias: &Vector3<f64>| forces.iter().map(|force| unit(force - bias)).collect::<Vec<_>>();
    if found.len() >= FEWEST {
        for _ in 0..ROUNDS {
            let off = |(force, up): (&Vector3<f64>, &Vector3<f64>)| Some(force - nearest(directions, up)?);
            let off: Vec<Vector3<f64>> = forces.iter().zip(&ups(&bias)).filter_map(off).collect();
            // a hold on no face moves the median little
            bias = Vector3::from_fn(|axis, _| median(off.iter().map(|off| off[axis]).collect()));
        }
    }
    Ok(ups(&bias))
}

fn by_ends(found: &[Hold]) -> Result<Vec<Vector3<f64>>> {
    let Some(first) = found.first() else { return Ok(Vec::new()) };
    let least = found.iter().fold(first.mean, |least, hold| least.inf(&hold.mean));
    let most = found.iter().fold(first.mean, |most, hold| most.sup(&hold.mean));
    let (half, centre) = (0.5 * (most - least), 0.5 * (most + least));
    let ups: Vec<Vector3<f64>> = found.iter().map(|hold| (hold.mean - centre).component_div(&half)).collect();
    let norm = median(ups.iter().map(Vector3::norm).collect());
    if !(LONGEST.recip()..=LONGEST).contains(&norm) {
        return refused(
            Refusal::HoldsMissing,
            "the readings do not show which way is up: without a gain and an offset each axis must have been up and down".into(),
            "hold the faces that are missing, state gain and offset of the datasheet, or give holds.intervals_s in the order of holds.directions",
        );
    }
    Ok(ups.into_iter().map(unit).collect())
}

fn unit(of: Vector3<f64>) -> Vector3<f64> {
    of.try_normalize(0.0).unwrap_or_else(Vector3::z)
}

fn refused<T>(refusal: Refusal, message: String, help: &str) -> Result<T> {
    Err(Error::recording(InputError::new(refusal, message, help)))
}
