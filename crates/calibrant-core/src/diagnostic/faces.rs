//! Fields of diagnostics about faces (holds of known direction): an axis that points up or down, and a hold whose given direction the accelerometer contradicts.

use crate::diagnostic::direction::direction_in_words;
use crate::diagnostic::hold_span::HoldSpan;
use crate::diagnostic::parts::{Part, Parts};
use crate::sensor::Axis;
use nalgebra::Vector3;
use std::fmt;

/// An axis that points up or down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FacePointing {
    /// The axis.
    pub axis: Axis,
    /// Does it point up?
    pub is_up: bool,
}

impl Part for FacePointing {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(format!("axis {} {}", self.axis, if self.is_up { "up" } else { "down" }));
    }
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
