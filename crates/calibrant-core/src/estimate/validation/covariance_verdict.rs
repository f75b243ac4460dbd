//! What errors on unused data say of the covariance.

/// A factor between prediction and error so close to one is no reason to doubt, however sure it is.
pub(super) const CLOSE: f64 = 1.25;

/// Where upper and lower end of the factor's interval are further apart than this, nothing is believed: three errors or fewer.
const OPEN: f64 = 10.0;

/// A factor beyond this, or below its inverse, is no agreement, however wide its interval.
const AGREES: f64 = 2.0;

/// What errors on unused data say of the covariance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CovarianceVerdict {
    /// Errors are as large as predicted, or within a quarter of it.
    Believed,
    /// They are larger.
    TooSmall,
    /// They are smaller.
    LargerThanNeeded,
    /// They are too few to tell: the interval is wider than 1:10, or has 1 in it with a factor beyond 2.
    TooFew,
    /// Those that count are as large as predicted, and confirm nothing: see [`ValidatedErrors::caveat`](super::ValidatedErrors::caveat).
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

    /// What a factor of errors over prediction and its 99 % interval say.
    #[must_use]
    pub fn of(factor: f64, interval: (f64, f64)) -> Self {
        if interval.0 > 1.0 && factor > CLOSE {
            Self::TooSmall
        } else if interval.1 < 1.0 && factor < 1.0 / CLOSE {
            Self::LargerThanNeeded
        } else if interval.1 > OPEN * interval.0 || !(1.0 / AGREES..AGREES).contains(&factor) {
            Self::TooFew
        } else {
            Self::Believed
        }
    }
}

crate::json_name!(CovarianceVerdict);
