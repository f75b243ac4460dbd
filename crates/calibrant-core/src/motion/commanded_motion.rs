//! The commanded motion and how far it is trusted (`[motion] trust`). Plain data: no estimation here.

use super::{JerkControlledMotion, MotionClock, MotionGravity};
use crate::json_name;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How far the commanded motion is trusted. The thesis's problems (5), (6) and (3) are one problem with three
/// answers to this question.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trust {
    /// The arm did exactly what was commanded: linear least squares, the thesis's (5).
    Known,
    /// Commanded plus process noise on the jerk, the thesis's (6).
    Noisy(InputNoise),
    /// Only the acceleration at both ends is known, the thesis's (3).
    Unknown,
}

json_name!(Trust);

impl Trust {
    /// The process noise of a motion that is trusted with noise.
    #[must_use]
    pub fn input_noise(&self) -> Option<InputNoise> {
        match self {
            Self::Noisy(noise) => Some(*noise),
            Self::Known | Self::Unknown => None,
        }
    }

    /// As written in experiment files: `known`, `noisy`, `unknown`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Known => "known",
            Self::Noisy(_) => "noisy",
            Self::Unknown => "unknown",
        }
    }
}

/// Standard deviation of the process noise on the jerk: `σ_u(u) = floor + ratio · |u|`, per axis, m/s³.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct InputNoise {
    /// Noise that is there at any jerk, m/s³.
    pub floor_mps3: f64,
    /// Noise relative to the commanded jerk.
    pub ratio: f64,
}

impl InputNoise {
    /// `σ_u(u)`, m/s³, for each axis.
    #[must_use]
    pub fn sd(&self, jerk_mps3: &Vector3<f64>) -> Vector3<f64> {
        jerk_mps3.map(|u| self.floor_mps3 + self.ratio * u.abs())
    }
}

/// Which ends of the motion have a known acceleration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum KnownEnds {
    /// Only the start.
    Start,
    /// Start and end.
    Both,
}

/// A motion as it was commanded, and how far it is trusted.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandedMotion {
    /// What was commanded. Trust `unknown` uses only its first and last node.
    pub motion: JerkControlledMotion,
    /// How far it is trusted.
    pub trust: Trust,
    /// Which ends are known. Trust `unknown` needs both, trust `known` needs no answer.
    pub known_ends: KnownEnds,
    /// Gravity, where the sensor senses it beside the motion. `None`: the motion is all that it senses.
    pub gravity: Option<MotionGravity>,
    /// What is known of the recording's clock beside the motion's. Trust `unknown` takes it as exact.
    pub clock: MotionClock,
}
