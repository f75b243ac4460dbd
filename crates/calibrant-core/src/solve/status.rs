//! The end of an iteration.

/// How the iteration ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CalibrationStatus {
    /// The step became smaller than the tolerance, in standard deviations of the parameters.
    Converged,
    /// The largest number of iterations was reached first. The numbers are the best that were found. Look at the residuals before you use them.
    IterationLimit,
    /// No step lowered the cost any more, but the step was not below the tolerance. The numbers are the best that were found.
    Stalled,
}

impl CalibrationStatus {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Converged, Self::IterationLimit, Self::Stalled];

    /// As written in results: `converged`, `iteration_limit`, `stalled`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::IterationLimit => "iteration_limit",
            Self::Stalled => "stalled",
        }
    }
}

crate::json_name!(CalibrationStatus, CalibrationStatus::ALL);
