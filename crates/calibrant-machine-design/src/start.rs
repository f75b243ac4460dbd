//! A start of the search.

use calibrant_design::DesignStatus;

/// One start of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryStart {
    /// Its number.
    pub number: usize,
    /// Distance of the knots that it reached, s.
    pub knot_s: f64,
    /// Value of the criterion there, in nats.
    pub value: f64,
    /// Did it reach the last stage, which minimises this value? Those before take the nuisances as known.
    pub polished: bool,
    /// Iterations.
    pub iterations: usize,
    /// How it ended.
    pub status: DesignStatus,
}
