//! What a validation gives.

use super::caveat::Caveat;
use super::covariance_verdict::CovarianceVerdict;
use super::explanation::LikelyExplanation;
use super::noise_comparison::NoiseRatio;
use super::unused_error::{ErrorKind, UnusedError};
use nalgebra::Vector3;

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
    pub reasons: Vec<LikelyExplanation>,
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
    pub caveat: Option<Caveat>,
}

/// What the errors say of the parameters alone: their common part along the directions in which the parameters would move them.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    pub factor_interval: (f64, f64),
}

/// The gyroscope's bias in another recording, less that of the calibration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BiasShift {
    /// The difference, rad/s.
    pub shift_radps: Vector3<f64>,
    /// Its predicted standard deviation, rad/s.
    pub sd_radps: Vector3<f64>,
    /// Probability of one at least this large if the bias is the same.
    pub p_value: f64,
    /// Has it moved? Then rates and rotations are judged with the bias it has moved to.
    pub moved: bool,
}

impl Validation {
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
