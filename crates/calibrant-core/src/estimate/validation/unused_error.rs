//! An error on data that were not used, and its kind.

use crate::form::As;
use nalgebra::DVector;
use schemars::JsonSchema;
use serde::Serialize;

/// A kind of error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// Corrected specific force in a hold: its magnitude less gravity, m/s².
    Magnitude,
    /// Corrected angular rate in a hold, where it is zero, rad/s per axis.
    Rate,
    /// Gravity carried by the gyroscope from a hold to the next one, less gravity found there, across it in two directions, rad.
    Rotation,
}

impl ErrorKind {
    /// As written in results: `magnitude`, `rate`, `rotation`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Magnitude => "magnitude",
            Self::Rate => "rate",
            Self::Rotation => "rotation",
        }
    }

    /// SI unit of the errors.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Magnitude => "m/s²",
            Self::Rate => "rad/s",
            Self::Rotation => "rad",
        }
    }
}

/// An error on data that were not used.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct UnusedError {
    /// The hold that a rotation begins with.
    #[serde(rename = "from_hold_index", skip_serializing_if = "Option::is_none")]
    pub from_hold: Option<usize>,
    /// The hold that it was found in, from 0: of the other recording, or of the recording's table of holds.
    #[serde(rename = "hold_index")]
    pub hold: usize,
    /// Begin of the hold or of the rotation, s.
    pub start_s: f64,
    /// Its end, s.
    pub end_s: f64,
    /// The block that it belongs to, from 0; 0 for another recording.
    #[serde(rename = "fold_index")]
    pub fold: usize,
    /// The error: one, two or three numbers in the kind's unit.
    #[serde(with = "As::<Vec<f64>>")]
    pub error: DVector<f64>,
    /// The standard deviation predicted of each.
    #[serde(with = "As::<Vec<f64>>")]
    pub predicted_sd: DVector<f64>,
    /// Its length in predicted standard deviations, over the root of the number of components: about 1.
    pub in_sd: f64,
    /// Does it count, or is it beyond what chance explains beside the others?
    pub counts: bool,
}

crate::json_name!(ErrorKind);
