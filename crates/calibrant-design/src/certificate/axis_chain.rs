//! One axis of a motion in the form that the certificate bounds.

use calibrant_core::motion::{AxisLimits, IntervalSums};

/// One axis of a chain of intervals of equal duration.
#[derive(Debug, Clone)]
pub(crate) struct AxisChain {
    /// Duration of an interval, s.
    pub(crate) interval_s: f64,
    /// Samples of each interval.
    pub(crate) sums: Vec<IntervalSums>,
    /// The limits; they hold for all t.
    pub(crate) limits: AxisLimits,
    /// The motion variance is `V = Σ α² − (Σ α + shift)²/mass`.
    pub(crate) shift: f64,
    /// The divisor of the mean's term: at least the number of samples.
    pub(crate) mass: f64,
}

/// The states that pass from interval to interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct States {
    pub(super) velocity: bool,
    pub(super) displacement: bool,
    pub(super) sum: bool,
}
