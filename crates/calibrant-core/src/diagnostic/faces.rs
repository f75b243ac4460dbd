//! Checks of faces: holds of known direction.

use super::check::checks;
use super::direction::direction_in_words;
use super::hold_span::HoldSpan;
use super::parts::{Part, Parts, listed};
use crate::sensor::Axis;
use nalgebra::Vector3;
use std::fmt;

checks! {
    /// All given directions of the holds differ from the accelerometer's by one rotation.
    FacesTurned "faces-turned" Error {
        /// The holds.
        faces: Vec<FaceMismatch>,
    }
    decided "Readings in SI show a different axis up than the given one."
    remedy "Correct the directions, unless the sensor is mounted that way."
    says format!(
        "{}. All directions are rotated in the same way. Correct them, unless the sensor is mounted that way: the \
         results are in the frame of the given directions.",
        listed(faces, "; ")
    );

    /// The holds were found, and not all of them are in one of the given directions, or a direction has none.
    FacesUnmatched "faces-unmatched" Note {
        /// Holds in none: the nearest direction, and what the accelerometer shows.
        holds: Vec<FaceMismatch>,
        /// Directions that have none.
        missing: Vec<String>,
    }
    decided "A hold is in a direction if its mean shows it within 20°."
    remedy "Lay the sensor on the face that is missing; give holds.intervals_s where the holds are not the ones that were found."
    says {
        let off = format!("in none of holds.directions, and not used: {}", listed(&unmatched(holds), ", "));
        let open = format!("no hold has {} up", listed(missing, ", or "));
        let said = [(off, holds.is_empty()), (open, missing.is_empty())];
        listed(&said.into_iter().filter(|(_, is_none)| !is_none).map(|(text, _)| text).collect::<Vec<_>>(), "; ")
    };

    /// A face was held for only a few samples.
    FaceBrief "face-brief" Warning {
        hold: HoldSpan,
        /// Its samples.
        samples: usize,
    }
    decided "It has too few samples for a hold of seconds."
    remedy "Correct its times."
    says format!("{hold} has only {samples} samples. A face is held for seconds. Check the times of the hold.");

    /// The faces scatter far beyond their noise.
    FacesScatter "faces-scatter" Warning {
        /// Scatter of their directions, rad.
        tilt_rad: f64,
        /// Scatter along gravity, m/s².
        along_mps2: f64,
        /// Largest error, rad.
        worst_rad: f64,
        /// The faces with the largest error.
        worst: Vec<HoldSpan>,
    }
    decided "The scatter exceeds that of faces set by hand."
    remedy "Correct directions and times of the holds."
    says format!(
        "beyond their noise, the faces scatter by {:.1}° in direction and by {along_mps2:.2} m/s² along gravity. The \
         largest error is {:.1}°, in {}. Check the directions and the times of the holds.",
        tilt_rad.to_degrees(),
        worst_rad.to_degrees(),
        listed(worst, ", or ")
    );

    /// The faces scatter by more than the given alignment.
    TiltContradicted "tilt-contradicted" Warning {
        /// Standard deviation of the tilt that the faces show, rad.
        shown_rad: f64,
        /// Given standard deviation of the tilt, rad.
        given_rad: f64,
    }
    decided "The χ² of the faces is too large for the given alignment: p < 0.001."
    remedy "Correct holds.face_sd_deg, and the times and directions of the holds."
    says format!(
        "the faces scatter by {:.2}° about each axis, but holds.face_sd_deg says {:.2}°. The standard deviations follow \
         the scatter. Correct holds.face_sd_deg, and check times and directions of the holds.",
        shown_rad.to_degrees(),
        given_rad.to_degrees()
    );

    /// The faces are too few to estimate their alignment. The program assumes a value.
    TiltAssumed "tilt-assumed" Warning {
        /// Number of faces.
        faces: usize,
        /// Standard deviation of the tilt, rad.
        tilt_rad: f64,
    }
    decided "No degrees of freedom are left for it."
    remedy "Give holds.face_sd_deg, or hold more faces."
    says format!(
        "{faces} faces are too few to estimate the face alignment. The program assumes {:.1}° about each axis. Add \
         faces, or give holds.face_sd_deg.",
        tilt_rad.to_degrees()
    );
}

/// An axis that points up or down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FacePointing {
    /// The axis.
    pub axis: Axis,
    /// Does it point up?
    pub is_up: bool,
}

/// `the x axis pointing up`.
impl fmt::Display for FacePointing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the {} axis pointing {}", self.axis, if self.is_up { "up" } else { "down" })
    }
}

impl Part for FacePointing {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(format!("axis {} {}", self.axis, if self.is_up { "up" } else { "down" }));
    }
}

/// Holds that are on no face, with what they show: by their times, since those on faces are numbered without them.
fn unmatched(holds: &[FaceMismatch]) -> Vec<String> {
    let times = |of: &HoldSpan| format!("{:.1} to {:.1} s", of.start_s, of.end_s);
    holds.iter().map(|of| format!("{} with {} up", times(&of.hold), direction_in_words(&of.shown))).collect()
}

/// A hold whose given direction differs from the accelerometer's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceMismatch {
    /// The hold.
    pub hold: HoldSpan,
    /// Up, as it was given.
    pub given: Vector3<f64>,
    /// Up, as the accelerometer shows it.
    pub shown: Vector3<f64>,
}

impl fmt::Display for FaceMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} is given with {} up, but the accelerometer shows {} up",
            self.hold,
            direction_in_words(&self.given),
            direction_in_words(&self.shown)
        )
    }
}

impl Part for FaceMismatch {
    fn add_to(&self, parts: &mut Parts, key: &'static str) {
        self.hold.add_to(parts, key);
    }
}
