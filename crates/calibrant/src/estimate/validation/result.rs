//! What a validation gives.

use super::doubt::Doubt;
use super::noise::NoiseRatio;
use super::reason::LikelyReason;
use nalgebra::{DVector, Vector3};

/// A factor between prediction and error so close to one is no reason to doubt, however sure it is.
pub(super) const CLOSE: f64 = 1.25;
/// Where upper and lower end of the factor's interval are further apart than this, nothing is believed: three errors or fewer.
const OPEN: f64 = 10.0;

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
    pub reasons: Vec<LikelyReason>,
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

/// All errors of one kind beside what was predicted of them.
#[derive(Debug, Clone)]
pub struct ValidatedErrors {
    /// The kind.
    pub kind: ErrorKind,
    /// The errors, in order of time. Where the gyroscope's bias has moved, its rates are less the bias it has moved to.
    pub errors: Vec<UnusedError>,
    /// Root mean square of the lengths of the errors that count, in the kind's unit.
    pub rms: f64,
    /// What was predicted of it.
    pub predicted_rms: f64,
    /// `eᵀ C⁻¹ e` of those that count.
    pub chi2: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Probability of a χ² at least this large if the covariance is right. Where part of it was estimated from the scatter of the calibration's
    /// data, that scatter's own uncertainty counts: Fisher's F in place of χ².
    pub p_value: f64,
    /// Errors over prediction, `√(χ²/n)`; for folds over the mean that χ²/n has where the scatter of a calibration on fewer data is less certain.
    pub factor: f64,
    /// 99 % confidence interval of the factor by which the standard deviations are off.
    pub factor_interval: (f64, f64),
    /// The part of it that the parameters answer for; `None` for folds, which share their data, and where it is too small to be seen.
    pub parameters: Option<ParameterPart>,
    /// What follows.
    pub verdict: CovarianceVerdict,
    /// Why errors as large as predicted confirm nothing; `None` where nothing speaks against them.
    pub doubt: Option<Doubt>,
}

/// An error on data that were not used.
#[derive(Debug, Clone, PartialEq)]
pub struct UnusedError {
    /// The hold that it was found in, from 0: of the other recording, or of the recording's table of holds.
    pub hold: usize,
    /// The hold that a rotation begins with.
    pub from_hold: Option<usize>,
    /// Begin of the hold or of the rotation, s.
    pub start_s: f64,
    /// Its end, s.
    pub end_s: f64,
    /// The block that it belongs to, from 0; 0 for another recording.
    pub fold: usize,
    /// The error: one, two or three numbers in the kind's unit.
    pub error: DVector<f64>,
    /// The standard deviation predicted of each.
    pub predicted_sd: DVector<f64>,
    /// Its length in predicted standard deviations, over the root of the number of components: about 1.
    pub in_sd: f64,
    /// Does it count, or is it beyond what chance explains beside the others?
    pub counts: bool,
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

/// What errors on unused data say of the covariance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CovarianceVerdict {
    /// Errors are as large as predicted, or within a quarter of it.
    Believed,
    /// They are larger.
    TooSmall,
    /// They are smaller.
    LargerThanNeeded,
    /// They are too few to tell: neither contradicted nor confirmed within a factor of about three.
    TooFew,
    /// Those that count are as large as predicted, and confirm nothing: see [`ValidatedErrors::doubt`].
    Doubtful,
}

impl CovarianceVerdict {
    /// As written in results: `believed`, `too_small`, `larger_than_needed`, `too_few`, `doubtful`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Believed => "believed",
            Self::TooSmall => "too_small",
            Self::LargerThanNeeded => "larger_than_needed",
            Self::TooFew => "too_few",
            Self::Doubtful => "doubtful",
        }
    }

    /// What a factor and its interval say.
    pub(super) fn of(factor: f64, interval: (f64, f64)) -> Self {
        if interval.0 > 1.0 && factor > CLOSE {
            Self::TooSmall
        } else if interval.1 < 1.0 && factor < 1.0 / CLOSE {
            Self::LargerThanNeeded
        } else if interval.1 > OPEN * interval.0 {
            Self::TooFew
        } else {
            Self::Believed
        }
    }
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
