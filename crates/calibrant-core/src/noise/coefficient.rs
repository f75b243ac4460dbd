//! A coefficient of the noise: its estimate with an interval, or the reason why the recording does not
//! determine it.

/// An estimate with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Standard uncertainty.
    pub sd: f64,
    /// Lower bound of the 95 % confidence interval.
    pub low: f64,
    /// Upper bound of the 95 % confidence interval.
    pub high: f64,
}

impl Estimate {
    /// The same in another unit.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            sd: factor * self.sd,
            low: factor * self.low,
            high: factor * self.high,
        }
    }
}

/// A coefficient, determined by a recording or not.
#[derive(Debug, Clone, PartialEq)]
pub enum Coefficient {
    /// The recording determines it.
    Determined(Estimate),
    /// The recording does not determine it.
    NotDetermined {
        /// The coefficient is below this with 95 % confidence, where the recording sets a limit.
        limit: Option<f64>,
        /// Why it is not determined, and what would help.
        reason: String,
    },
}

impl Coefficient {
    /// Why it is not determined.
    #[must_use]
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Determined(_) => None,
            Self::NotDetermined { reason, .. } => Some(reason),
        }
    }

    /// The estimate, where it is determined.
    #[must_use]
    pub fn estimate(&self) -> Option<&Estimate> {
        match self {
            Self::Determined(estimate) => Some(estimate),
            Self::NotDetermined { .. } => None,
        }
    }

    /// The value, where it is determined.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        self.estimate().map(|estimate| estimate.value)
    }

    /// The upper limit, where it is not determined.
    #[must_use]
    pub fn limit(&self) -> Option<f64> {
        match self {
            Self::Determined(_) => None,
            Self::NotDetermined { limit, .. } => *limit,
        }
    }
}
