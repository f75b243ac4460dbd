//! Which of the known directions each hold is in, where nobody gave times: the one that its mean shows. The errors of a sensor are far smaller than
//! the angles between faces.

use crate::diagnostic::faces::FacesUnmatched;
use crate::diagnostic::{Diagnostic, FaceMismatch, HoldSpan, direction_in_words};
use crate::error::{Error, InputError, Refusal, Result};
use crate::motion::Hold;
use crate::sensor::{Correction, Sensor};
use nalgebra::Vector3;

/// A hold is in a direction that it is at most this far from, rad: 20°. A bias of 0.2 g and a box that is off level by 5° stay below it.
pub const ON_FACE_RAD: f64 = 0.35;

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
    for (number, (hold, up)) in found.iter().zip(shown(sensor, found)?).enumerate() {
        let Some(near) = nearest(directions, &up) else { continue };
        if near.angle(&up) <= ON_FACE_RAD {
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

/// Which way is up in each hold, by the datasheet; where it states no gain, by the largest and the smallest reading of each axis.
fn shown(sensor: &Sensor, found: &[Hold]) -> Result<Vec<Vector3<f64>>> {
    let unit = |of: Vector3<f64>| of.try_normalize(0.0).unwrap_or_else(Vector3::z);
    if let Some(correction) = sensor.nominal().as_ref().and_then(Correction::of) {
        return Ok(found.iter().map(|hold| unit(correction.apply(&hold.mean))).collect());
    }
    let Some(first) = found.first() else { return Ok(Vec::new()) };
    let least = found.iter().fold(first.mean, |least, hold| least.inf(&hold.mean));
    let most = found.iter().fold(first.mean, |most, hold| most.sup(&hold.mean));
    let (half, centre) = (0.5 * (most - least), 0.5 * (most + least));
    if half.min() <= 0.5 * half.max() {
        return refused(
            "the readings do not show which way is up: without a gain and an offset each axis must have been up and down".into(),
            "hold the faces that are missing, state gain and offset of the datasheet, or give holds.intervals_s in the order of holds.directions",
        );
    }
    Ok(found.iter().map(|hold| unit((hold.mean - centre).component_div(&half))).collect())
}

fn refused<T>(message: String, help: &str) -> Result<T> {
    Err(Error::recording(InputError::new(Refusal::HoldsInvalid, message, help)))
}
