//! The pointwise limits at all times of a grid, as rows of an optimisation problem in the unknowns.
//!
//! A row depends on the unknowns of the four control points of its interval, which are neighbours. A row far from its limit is constant, and has no derivative.

use super::band::{Band, dot};
use super::gram::add_squares;
use crate::limits::{PointRows, PointWork, Pointwise};
use crate::motion::{Grid, Knots, Ties};
use nalgebra::DMatrix;
use std::ops::Range;

/// Rows, and their derivatives where they were asked for last.
pub(crate) struct Rows<'a> {
    pointwise: Pointwise<'a>,
    grid: Grid,
    work: PointWork,
    n: usize,
    /// Rows at one time: of positions alone, and of the state of the joints.
    positions: usize,
    states: usize,
    /// One value for each time and row.
    pub(crate) values: Vec<f64>,
    /// Derivatives at one time, by the joints.
    by_position: Vec<f64>,
    by_state: Vec<f64>,
    /// Size of each joint's unknowns.
    sizes: Vec<f64>,
    times: Vec<Time>,
    intervals: Vec<Interval>,
    /// Places of values that have derivatives, interval by interval, and these by the interval's unknowns.
    places: Vec<usize>,
    slopes: Vec<f64>,
}

/// How the state of the joints depends on the unknowns of the interval.
#[derive(Debug, Clone)]
struct Time {
    /// Of position, velocity and acceleration, for each of the interval's unknowns of a joint.
    weights: Vec<[f64; 3]>,
}

/// What belongs to an interval.
#[derive(Debug, Clone)]
struct Interval {
    times: Range<usize>,
    unknowns: Range<usize>,
    /// Of the places with derivatives, and of their slopes.
    places: Range<usize>,
    slopes: Range<usize>,
}

impl<'a> Rows<'a> {
    /// At this number of times in each interval.
    pub(crate) fn new(pointwise: Pointwise<'a>, knots: Knots, times: usize, ties: &Ties) -> Self {
        let grid = Grid::even(knots, times);
        let n = pointwise.problem.chain.joints.len();
        let positions = pointwise.position_rows();
        let states = pointwise.rows() - positions;
        let work = pointwise.work();
        let interval = |i: usize| {
            let end = if i + 1 == knots.intervals { grid.len() } else { (i + 1) * times };
            let of = || (i..i + 4).filter_map(|control| ties.of(control));
            let unknowns =
                of().next().map_or(0..0, |first| n * first..n * (of().next_back().unwrap_or(first) + 1));
            Interval { times: i * times..end, unknowns, places: 0..0, slopes: 0..0 }
        };
        let intervals: Vec<Interval> = (0..knots.intervals).map(interval).collect();
        let time = |k: usize| {
            let (i, of) = grid.rows(k);
            let unknowns = &intervals[i].unknowns;
            let mut weights = vec![[0.0; 3]; unknowns.len() / n];
            for r in 0..4 {
                if let Some(unknown) = ties.of(i + r) {
                    for (sum, of) in weights[unknown - unknowns.start / n].iter_mut().zip(of) {
                        *sum += of[r];
                    }
                }
            }
            Time { weights }
        };
        Self {
            n,
            positions,
            states,
            values: vec![1.0; grid.len() * (positions + states)],
            by_position: vec![0.0; positions * n],
            by_state: vec![0.0; states * 3 * n],
            sizes: (0..n).map(|j| ties.size(j)).collect(),
            times: (0..grid.len()).map(time).collect(),
            intervals,
            places: Vec::new(),
            slopes: Vec::new(),
            pointwise,
            grid,
            work,
        }
    }

    /// Values, with derivatives where they are wanted. Gives the least value.
    pub(crate) fn evaluate(&mut self, controls: &DMatrix<f64>, with_slopes: bool) -> f64 {
        let rows = self.positions + self.states;
        if with_slopes {
            self.places.clear();
            self.slopes.clear();
        }
        for i in 0..self.intervals.len() {
            let (places, slopes) = (self.places.len(), self.slopes.len());
            for k in self.intervals[i].times.clone() {
                let at = PointRows {
                    values: &mut self.values[k * rows..(k + 1) * rows],
                    by_position: &mut self.by_position,
                    by_state: &mut self.by_state,
                    with_slopes,
                };
                self.pointwise.at(&mut self.work, &self.grid, k, controls, at);
                if with_slopes {
                    self.take_slopes(k);
                }
            }
            if with_slopes {
                self.intervals[i].places = places..self.places.len();
                self.intervals[i].slopes = slopes..self.slopes.len();
            }
        }
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The derivatives at time `k`, by the unknowns of its interval.
    fn take_slopes(&mut self, k: usize) {
        let (n, first) = (self.n, k * (self.positions + self.states));
        let weights = &self.times[k].weights;
        for (row, of) in self.by_position.chunks_exact(n).enumerate() {
            // a distance beyond what matters is 1
            if self.values[first + row] < 1.0 {
                self.places.push(first + row);
                for [by_position, ..] in weights {
                    self.slopes
                        .extend(of.iter().zip(&self.sizes).map(|(slope, size)| by_position * slope * size));
                }
            }
        }
        for (row, of) in self.by_state.chunks_exact(3 * n).enumerate() {
            self.places.push(first + self.positions + row);
            let ((q, rest), sizes) = (of.split_at(n), &self.sizes[..n]);
            let (qd, qdd) = rest.split_at(n);
            for [by_q, by_qd, by_qdd] in weights {
                let slope = |j: usize| (by_q * q[j] + by_qd * qd[j] + by_qdd * qdd[j]) * sizes[j];
                self.slopes.extend((0..n).map(slope));
            }
        }
    }

    /// Adds `Σ multiplier · ∂row/∂x`.
    pub(crate) fn add_transposed(&self, multipliers: &[f64], out: &mut [f64]) {
        for Interval { unknowns, places, slopes, .. } in &self.intervals {
            let out = &mut out[unknowns.clone()];
            let rows = self.slopes[slopes.clone()].chunks_exact(unknowns.len().max(1));
            for (place, slopes) in self.places[places.clone()].iter().zip(rows) {
                let multiplier = multipliers[*place];
                for (out, slope) in out.iter_mut().zip(slopes) {
                    *out += multiplier * slope;
                }
            }
        }
    }

    /// How the rows change along a direction.
    pub(crate) fn changes(&self, direction: &[f64], changes: &mut [f64]) {
        changes.fill(0.0);
        for Interval { unknowns, places, slopes, .. } in &self.intervals {
            let direction = &direction[unknowns.clone()];
            let rows = self.slopes[slopes.clone()].chunks_exact(unknowns.len().max(1));
            for (place, slopes) in self.places[places.clone()].iter().zip(rows) {
                changes[*place] = dot(slopes, direction);
            }
        }
    }

    /// Adds `Σ weight · ∂row ∂rowᵀ`.
    pub(crate) fn add_squares(&self, weights: &[f64], band: &mut Band) {
        let mut square = Vec::new();
        for Interval { unknowns, places, slopes, .. } in &self.intervals {
            let (width, places) = (unknowns.len(), &self.places[places.clone()]);
            if width == 0 {
                continue;
            }
            square.clear();
            square.resize(width * width, 0.0);
            add_squares(&self.slopes[slopes.clone()], width, |row| weights[places[row]], &mut square);
            for a in 0..width {
                band.add_row(unknowns.start + a, unknowns.start, &square[a * width..=a * width + a]);
            }
        }
    }
}
