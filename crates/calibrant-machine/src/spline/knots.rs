//! Knots at equal distances.

use super::{Degree, Weights};

/// Uniform knots: `intervals` intervals of `step_s` from `start_s` on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformKnots {
    /// First knot, s.
    pub start_s: f64,
    /// Distance between knots, s.
    pub step_s: f64,
    /// Number of intervals.
    pub intervals: usize,
    /// Degree of the spline on them.
    pub degree: Degree,
}

impl UniformKnots {
    /// Knots of at most this distance from `start_s` to `end_s`.
    #[must_use]
    pub fn covering(start_s: f64, end_s: f64, step_s: f64, degree: Degree) -> Self {
        let intervals = ((end_s - start_s) / step_s - 1e-9).ceil().max(1.0);
        Self { start_s, step_s: (end_s - start_s) / intervals, intervals: intervals as usize, degree }
    }

    /// Number of control points.
    #[must_use]
    pub fn controls(&self) -> usize {
        self.intervals + self.degree.number()
    }

    /// Last knot, s.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.start_s + self.step_s * self.intervals as f64
    }

    /// The interval that a time lies in; the first or the last for times outside.
    #[must_use]
    pub fn interval(&self, time_s: f64) -> usize {
        let place = (time_s - self.start_s) / self.step_s;
        (place.max(0.0) as usize).min(self.intervals - 1)
    }

    /// Time of interval `i`'s beginning, s.
    #[must_use]
    pub fn knot_s(&self, i: usize) -> f64 {
        self.start_s + self.step_s * i as f64
    }

    /// The weights of the control points at a time. Outside the knots the polynomial of the first or last interval continues.
    #[must_use]
    pub fn weights(&self, time_s: f64) -> Weights {
        let interval = self.interval(time_s);
        let u = (time_s - self.knot_s(interval)) / self.step_s;
        Weights::at(interval, u, self.step_s, self.degree)
    }

    /// Time at which control point `i` has most weight (its Greville abscissa), s.
    #[must_use]
    pub fn centre_s(&self, i: usize) -> f64 {
        self.start_s + self.step_s * (i as f64 - 0.5 * (self.degree.number() as f64 - 1.0))
    }
}
