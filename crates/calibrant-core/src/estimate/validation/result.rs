//! What a validation gives.

use super::covariance_verdict::CovarianceVerdict;
use super::noise_comparison::NoiseRatio;
use super::unused_error::{ErrorKind, UnusedError};
use crate::diagnostic::Diagnostic;
use crate::form::{As, per_axis};
use crate::json::{if_any, if_some, named};
use crate::json_object;
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// A calibration on data that were not used for it.
#[derive(Debug, Clone)]
pub struct Validation {
    /// Where these data come from.
    pub source: ValidationSource,
    /// The kinds of errors that could be looked at, in the order of [`ErrorKind`].
    pub kinds: Vec<ValidatedErrors>,
    /// How far the gyroscope's bias is from the calibration's; `None` without a gyroscope, and for folds of one recording.
    pub bias_shift: Option<BiasShift>,
    /// The noise of each sensor beside that of the calibration's recording; empty for folds. What is predicted goes with the noise that is found.
    pub noise: Vec<NoiseRatio>,
    /// What may be the reason of errors that are larger than predicted, other than the covariance; empty for folds.
    pub likely_explanations: Vec<Diagnostic>,
}

/// Data that were not used.
#[derive(Debug, Clone, PartialEq)]
pub enum ValidationSource {
    /// Another recording.
    Recording {
        /// Its name, for people; empty until someone gives it one.
        name: String,
    },
    /// Blocks of the recording's own holds, each predicted by a calibration without it.
    Folds {
        /// Number of blocks.
        folds: usize,
        /// Blocks that could not be predicted.
        failed: Vec<FailedFold>,
    },
}

/// A block of holds without which there is no calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct FailedFold {
    /// Its first and its last hold, from 0.
    pub holds: (usize, usize),
    /// What is wrong, in words.
    pub reason: String,
}

/// All errors of one kind beside what was predicted of them.
#[derive(Debug, Clone)]
pub struct ValidatedErrors {
    /// The kind.
    pub kind: ErrorKind,
    /// The errors, in order of time. Where the gyroscope's bias has moved, its rates are less the bias it has moved to.
    pub errors: Vec<UnusedError>,
    /// Orientations, or rotations from one to another, that differ by 10° among those that count.
    pub distinct: usize,
    /// Root mean square of the lengths of the errors that count, in the kind's unit. Each counts with the inverse of its predicted variance.
    pub rms: f64,
    /// What was predicted of it.
    pub predicted_rms: f64,
    /// `eᵀ C⁻¹ e` of those that count.
    pub chi2: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Probability of a factor at least this large if the covariance is right. Where part of it was estimated from the scatter of the calibration's
    /// data, that scatter's own uncertainty counts: Fisher's F in place of χ².
    pub p_value: f64,
    /// Errors over prediction, `rms/predicted_rms`.
    pub factor: f64,
    /// 99 % confidence interval of the factor by which the standard deviations are off, for all kinds together.
    pub factor_interval: (f64, f64),
    /// The part of it that the parameters answer for; `None` for folds, which share their data, and where it is too small to be seen.
    pub parameters: Option<ParameterPart>,
    /// What follows.
    pub verdict: CovarianceVerdict,
    /// Why errors as large as predicted confirm nothing; `None` where nothing speaks against them.
    pub caveat: Option<Diagnostic>,
}

/// What the errors say of the parameters alone: their common part along the directions in which the parameters would move them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct ParameterPart {
    /// χ² of this part.
    pub chi2: f64,
    /// Number of directions.
    pub degrees_of_freedom: usize,
    /// Probability of a χ² at least this large if the parameters' covariance is right.
    pub p_value: f64,
    /// By how much the standard deviations of the parameters would have to be multiplied; 0 where the errors need no uncertainty of the parameters at all.
    pub factor: f64,
    /// Its 99 % confidence interval; it reaches to 0, or to infinity, where these data leave it open.
    #[serde(rename = "factor_interval_99", with = "As::<[Option<f64>; 2]>")]
    pub factor_interval: (f64, f64),
}

/// The gyroscope's bias in another recording, less that of the calibration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct BiasShift {
    /// The difference, rad/s.
    #[serde(with = "As::<[f64; 3]>")]
    pub shift_radps: Vector3<f64>,
    /// Its predicted standard deviation, rad/s.
    #[serde(rename = "shift_sd_radps", with = "As::<[f64; 3]>")]
    pub sd_radps: Vector3<f64>,
    /// Probability of one at least this large if the bias is the same.
    pub p_value: f64,
    /// Has it moved? Then rates and rotations are judged with the bias it has moved to.
    pub moved: bool,
}

json_object! {
    /// A calibration on data that were not used for it.
    Validation as validation {
        /// The recording.
        file: if_some(validation.recording()),
        /// Number of blocks of holds.
        folds: if_some(validation.folds().map(|(folds, _)| folds)),
        failed_folds: if_any(validation.folds().map_or(&[][..], |(_, failed)| failed)),
        /// Scatter within the holds over that of the calibration's recording, by sensor and axis.
        noise_ratio: if_any(validation.noise.iter().map(|noise| (noise.sensor_kind.name(), per_axis(&noise.axes, 3))).collect::<BTreeMap<_, _>>()),
        /// The coarsest step of the readings, in their unit, by sensor.
        coarse_step: if_any(validation.noise.iter().filter_map(|noise| Some((noise.sensor_kind.name(), noise.coarse?.step))).collect::<BTreeMap<_, _>>()),
        gyroscope_bias_shift: if_some(validation.bias_shift),
        likely_explanations: if_any(validation.likely_explanations.as_slice()),
        kinds: named(validation.kinds.iter().map(|errors| (errors.kind.name(), errors))),
    }
}

json_object! {
    /// A block of holds without which there is no calibration.
    FailedFold as fold {
        /// Its first hold, from 0.
        first_hold_index: fold.holds.0,
        /// Its last hold, from 0.
        last_hold_index: fold.holds.1,
        /// Why there is no calibration without it.
        reason: &fold.reason,
    }
}

json_object! {
    /// All errors of one kind beside what was predicted of them.
    ValidatedErrors as kind {
        /// Unit of the errors.
        unit: kind.kind.unit(),
        /// Number of errors.
        errors: kind.errors.len(),
        /// How many of them count.
        counted: kind.counted(),
        /// Orientations, or rotations, that differ among those that count.
        distinct: kind.distinct,
        /// Root mean square of the errors that count, weighted by their predicted variances.
        rms: kind.rms,
        /// What was predicted of it.
        predicted_rms: kind.predicted_rms,
        /// χ² of the errors that count, with their predicted covariance.
        chi2: kind.chi2,
        /// Its degrees of freedom.
        degrees_of_freedom: kind.degrees_of_freedom,
        /// Probability of errors at least this large if the covariance is right.
        p_value: kind.p_value,
        /// Errors over prediction.
        factor: kind.factor,
        /// 99 % interval of the factor by which the standard deviations are off.
        factor_interval_99: [kind.factor_interval.0, kind.factor_interval.1],
        /// What follows of the covariance.
        verdict: kind.verdict,
        /// Why errors as large as predicted confirm nothing.
        caveat: if_some(kind.caveat.as_ref()),
        /// What the errors say of the parameters alone.
        parameters: if_some(kind.parameters),
        table: &kind.errors,
    }
}

impl Validation {
    /// The data: `recording` or `folds`.
    #[must_use]
    pub fn source_name(&self) -> &'static str {
        match self.source {
            ValidationSource::Recording { .. } => "recording",
            ValidationSource::Folds { .. } => "folds",
        }
    }

    fn recording(&self) -> Option<&str> {
        match &self.source {
            ValidationSource::Recording { name } => Some(name),
            ValidationSource::Folds { .. } => None,
        }
    }

    fn folds(&self) -> Option<(usize, &[FailedFold])> {
        match &self.source {
            ValidationSource::Recording { .. } => None,
            ValidationSource::Folds { folds, failed } => Some((*folds, failed)),
        }
    }

    /// The errors of one kind.
    #[must_use]
    pub fn of_kind(&self, kind: ErrorKind) -> Option<&ValidatedErrors> {
        self.kinds.iter().find(|errors| errors.kind == kind)
    }
}

impl ValidatedErrors {
    /// How many of them count.
    #[must_use]
    pub fn counted(&self) -> usize {
        self.errors.iter().filter(|error| error.counts).count()
    }

    /// Those beyond what chance explains beside the others.
    pub fn outlying(&self) -> impl Iterator<Item = &UnusedError> {
        self.errors.iter().filter(|error| !error.counts)
    }
}
