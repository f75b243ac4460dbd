//! Knots, and times at the same places in every interval.

use calibrant_machine::spline::{Degree, UniformKnots, VectorSpline, Weights};
use nalgebra::DMatrix;

/// Knots of a cubic spline from time 0 on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Knots {
    /// Distance of the knots `h`, s.
    pub(crate) step_s: f64,
    pub(crate) intervals: usize,
}

impl Knots {
    /// Control points of a joint.
    pub(crate) fn controls(&self) -> usize {
        self.intervals + 3
    }

    pub(crate) fn duration_s(&self) -> f64 {
        self.step_s * self.intervals as f64
    }

    /// Knots at half the distance.
    pub(crate) fn halved(&self) -> Self {
        Self { step_s: self.step_s / 2.0, intervals: 2 * self.intervals }
    }

    /// The spline with these control points: one row for each, one column for each joint.
    pub(crate) fn spline(&self, controls: &DMatrix<f64>) -> VectorSpline {
        let knots = UniformKnots {
            start_s: 0.0,
            step_s: self.step_s,
            intervals: self.intervals,
            degree: Degree::Cubic,
        };
        let rows = controls.row_iter().flat_map(|row| row.iter().copied().collect::<Vec<_>>());
        VectorSpline { knots, dimension: controls.ncols(), controls: rows.collect() }
    }
}

/// `rows[d][r]`: weight of control point `i + r` in the `d`-th derivative.
pub(crate) type KnotRows = [[f64; 4]; 4];

/// The weights of a cubic spline at `u` in an interval of length `step_s`.
pub(crate) fn rows_at(u: f64, step_s: f64) -> KnotRows {
    let weights = Weights::at(0, u, step_s, Degree::Cubic);
    weights.derivative.map(|of| [of[0], of[1], of[2], of[3]])
}

/// The same places in every interval, and at the end of the last one where that is wanted.
#[derive(Debug, Clone)]
pub(crate) struct Grid {
    pub(crate) knots: Knots,
    /// Places in an interval, from 0 to 1, and the weights there.
    places: Vec<(f64, KnotRows)>,
    end: Option<KnotRows>,
}

impl Grid {
    /// At these places.
    pub(crate) fn at(knots: Knots, places: impl IntoIterator<Item = f64>) -> Self {
        let places = places.into_iter().map(|u| (u, rows_at(u, knots.step_s))).collect();
        Self { knots, places, end: None }
    }

    /// At `count` places at equal distances, with both ends of the motion.
    pub(crate) fn even(knots: Knots, count: usize) -> Self {
        let places = (0..count).map(|k| k as f64 / count as f64);
        Self { end: Some(rows_at(1.0, knots.step_s)), ..Self::at(knots, places) }
    }

    /// Number of times.
    pub(crate) fn len(&self) -> usize {
        self.knots.intervals * self.places.len() + usize::from(self.end.is_some())
    }

    /// Interval and weights of time `k`.
    pub(crate) fn rows(&self, k: usize) -> (usize, &KnotRows) {
        match (k / self.places.len(), &self.end) {
            (i, Some(end)) if i == self.knots.intervals => (i - 1, end),
            (i, _) => (i, &self.places[k % self.places.len()].1),
        }
    }

    /// Time `k`, s.
    pub(crate) fn time_s(&self, k: usize) -> f64 {
        let i = k / self.places.len();
        let place = if i == self.knots.intervals { 0.0 } else { self.places[k % self.places.len()].0 };
        (i as f64 + place) * self.knots.step_s
    }
}

/// The `d`-th derivative of joint `j` with these weights, from interval `i` on.
#[inline(always)]
pub(crate) fn derivative(controls: &DMatrix<f64>, i: usize, row: &[f64; 4], j: usize) -> f64 {
    weighted(row, four(controls, i, j))
}

/// Position, velocity, acceleration and jerk of joint `j` with these weights, from interval `i` on.
#[inline(always)]
pub(crate) fn derivatives(controls: &DMatrix<f64>, i: usize, rows: &KnotRows, j: usize) -> [f64; 4] {
    let four = four(controls, i, j);
    let [a, b, c, d] = rows;
    [weighted(a, four), weighted(b, four), weighted(c, four), weighted(d, four)]
}

#[inline(always)]
fn four(controls: &DMatrix<f64>, i: usize, j: usize) -> &[f64] {
    let first = j * controls.nrows() + i;
    &controls.as_slice()[first..first + 4]
}

#[inline(always)]
fn weighted(row: &[f64; 4], four: &[f64]) -> f64 {
    row[0] * four[0] + row[1] * four[1] + row[2] * four[2] + row[3] * four[3]
}
